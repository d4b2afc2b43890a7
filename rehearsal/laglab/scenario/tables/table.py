"""What the tables are made of."""

import re
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

from laglab_control import limits
from laglab_gateway.values import Number, saying


class Table(BaseModel):
    """A table of a scenario; nothing else may stand in it."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class OptionsTable(dict[str, object]):
    """Keyword arguments of what somebody brought; what can be written in TOML."""

    def __hash__(self) -> int:  # type: ignore[override]
        """All of a scenario can be hashed."""
        return hash(repr(sorted(self.items())))


Options = Annotated[dict[str, object], AfterValidator(OptionsTable)]


def as_in(made: type, field: str) -> Any:
    """For the `Annotated` of a number that one of the controller's classes limits."""
    limit = limits(made)[field]
    return Field(gt=limit.least) if limit.above else Field(ge=limit.least)


def _split(value: object) -> object:
    """`X,Y,THETA`, as on the command line, into its parts."""
    if not isinstance(value, str) or re.fullmatch(r"\s*[a-z]+\s*", value):
        return value
    try:
        return [float(part) for part in value.split(",")]
    except ValueError:
        return value


Triple = tuple[Number, Number, Number]
Pose = Annotated[Triple, saying("three finite numbers, x, y and theta"), BeforeValidator(_split)]
"""x [m], y [m], theta [rad]; on the command line `X,Y,THETA`."""
POSE = "m, m, rad"
