"""The robots that ship: what each is called, and its table of variables."""

import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from laglab_fmu.models.car import CAR
from laglab_fmu.models.differential import DIFFERENTIAL
from laglab_fmu.models.omni import OMNI
from laglab_fmu.models.units import TYPES, UNITS
from laglab_fmu.models.variables import Role, Variable


@dataclass(frozen=True)
class Model:
    """A robot that ships."""

    name: str
    """Its FMUs' name without the version of FMI, and their model identifier."""
    fleet: str
    """The same of the FMU of many at once."""
    folder: str
    """Of its C files, in `src/robots`; for readers, `content/robots` has how it moves."""
    description: str
    variables: Sequence[Variable]

    @cached_property
    def reference(self) -> Mapping[str, int]:
        """Value reference by name."""
        return {variable.name: number for number, variable in enumerate(self.variables)}

    @property
    def fmus(self) -> tuple[str, ...]:
        """The names of its FMUs: each is a model name and the version of FMI."""
        return f"{self.name}2", f"{self.name}3", f"{self.fleet}3"

    @property
    def inputs(self) -> tuple[str, ...]:
        """The names of what it is told at every tick."""
        return tuple(each.name for each in self.variables if each.role is Role.INPUT)

    @cached_property
    def start(self) -> Mapping[str, float]:
        """Its parameters' start values by name."""
        return {each.name: each.start for each in self.variables if each.role is Role.PARAMETER}


ROBOT = Model(
    "Robot",
    "Fleet",
    "differential",
    "A differential-drive robot with wheel and sensor noise",
    DIFFERENTIAL,
)
MODELS = (
    ROBOT,
    Model("Car", "CarFleet", "car", "A car-like robot, whose steering lags, with noise", CAR),
    Model(
        "Omni", "OmniFleet", "omni", "An omnidirectional robot on three wheels, with noise", OMNI
    ),
)


def model_of(fmu: str) -> Model:
    """The robot whose FMU that is, such as Robot2."""
    return next(model for model in MODELS if fmu in model.fmus)


def model_named(name: str) -> Model:
    """The robot of that name. Raises ValueError: none that ships has it."""
    for model in MODELS:
        if model.name == name:
            return model
    raise ValueError(f"{name} is none of {', '.join(each.name for each in MODELS)}")


def token(fmu: str) -> str:
    """Says that a description and a binary belong together: of this FMU, made of this table."""
    table = model_of(fmu).variables
    return "{" + str(uuid.uuid5(uuid.NAMESPACE_URL, repr((fmu, table, TYPES, UNITS)))) + "}"
