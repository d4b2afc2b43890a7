"""The robots that ship: what each is called, and its table of variables."""

import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from laglab_fmu.models.car import CAR
from laglab_fmu.models.differential import DIFFERENTIAL
from laglab_fmu.models.omni import OMNI
from laglab_fmu.models.units import TYPES, UNITS
from laglab_fmu.models.variables import Variable

FLEET_NAME = "Fleet"


@dataclass(frozen=True)
class Model:
    """A robot that ships."""

    name: str
    """Its FMUs' name without the version of FMI, and their model identifier."""
    folder: str
    """Of its C files, in `src/robots`; for readers, `content/robots` has how it moves."""
    description: str
    variables: Sequence[Variable]
    has_fleet: bool = False

    @cached_property
    def reference(self) -> Mapping[str, int]:
        """Value reference by name."""
        return {variable.name: number for number, variable in enumerate(self.variables)}

    @property
    def fmus(self) -> tuple[str, ...]:
        """The names of its FMUs: each is a model name and the version of FMI."""
        own = (f"{self.name}2", f"{self.name}3")
        return (*own, f"{FLEET_NAME}3") if self.has_fleet else own


ROBOT = Model(
    "Robot",
    "differential",
    "A differential-drive robot with wheel and sensor noise",
    DIFFERENTIAL,
    has_fleet=True,
)
MODELS = (
    ROBOT,
    Model("Car", "car", "A car-like robot, whose steering lags, with noise", CAR),
    Model("Omni", "omni", "An omnidirectional robot on three wheels, with noise", OMNI),
)


def model_of(fmu: str) -> Model:
    """The robot whose FMU that is, such as Robot2."""
    return next(model for model in MODELS if fmu in model.fmus)


def token(fmu: str) -> str:
    """Says that a description and a binary belong together: of this FMU, made of this table."""
    table = model_of(fmu).variables
    return "{" + str(uuid.uuid5(uuid.NAMESPACE_URL, repr((fmu, table, TYPES, UNITS)))) + "}"
