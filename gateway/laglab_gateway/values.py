"""The values that users give: what each may be, its unit and what it is for, all in its type.

A class made by `checked` is a frozen dataclass that refuses every other value, whoever makes it.
Whatever reads its values from a file, or describes them, finds all in the fields' metadata.
"""

from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Annotated, Any, TypeVar, dataclass_transform

from pydantic import (
    ConfigDict,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)
from pydantic.dataclasses import dataclass
from pydantic_core import ErrorDetails, PydanticCustomError

from laglab_gateway.errors import ConfigError

__all__ = [
    "Duration",
    "NotNegative",
    "Number",
    "Positive",
    "Probability",
    "Seconds",
    "Switch",
    "Ticks",
    "Whole",
    "checked",
    "described",
    "saying",
    "wording",
]

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0)]
NotNegative = Annotated[Number, Field(ge=0)]
Probability = Annotated[Number, Field(ge=0, le=1)]
Seconds = NotNegative
Duration = Annotated[float, Field(strict=True, gt=0)]
"""[s]; `inf` for what has no end."""
Switch = Annotated[bool, Field(strict=True)]
Whole = Annotated[int, Field(strict=True)]
Ticks = Annotated[Whole, Field(ge=0)]

T = TypeVar("T")


def described(unit: str, sentence: str) -> Any:
    """What to say of a field, in its `Annotated`; the unit of what has none, such as a name, is -,
    of a number without a dimension 1."""
    return Field(description=sentence, json_schema_extra={"unit": unit})


def saying(allowed: str) -> WrapValidator:
    """For the `Annotated` of a value made of several: what it must be, whatever is wrong in it."""

    def validate(value: object, inner: ValidatorFunctionWrapHandler) -> object:
        try:
            return inner(value)
        except ValidationError:
            raise PydanticCustomError("saying", f"{INSTEAD}{allowed}") from None

    return WrapValidator(validate)


@dataclass_transform(frozen_default=True)
def checked(cls: type[T]) -> type[T]:
    """A frozen dataclass. Making one raises ConfigError, naming the field, for a value that its
    type does not allow."""
    made: Any = dataclass(cls, frozen=True, config=ConfigDict(extra="forbid"))
    made.__init__ = _refusing(made.__init__, made)
    refusing: type[T] = made
    return refusing


def _refusing(fill: Callable[..., None], made: type[Any]) -> Callable[..., None]:
    @wraps(fill)
    def init(self: object, *values: object, **named: object) -> None:
        try:
            fill(self, *values, **named)
        except ValidationError as error:
            problem = error.errors()[0]
            place = problem["loc"][0]
            name = fields(made)[place].name if isinstance(place, int) else place
            raise ConfigError(f"{name}: {wording(problem)}") from None

    return init


INSTEAD = "Input should be "
"""So begins what pydantic says of a value that is something else."""
ALLOWED = {
    "bool_type": "true or false",
    "dataclass_type": "a table",
    "float_type": "a number",
    "greater_than": "above {gt:.10g}",
    "greater_than_equal": "{ge:.10g} or more",
    "int_type": "a whole number",
    "less_than": "below {lt:.10g}",
    "less_than_equal": "{le:.10g} or less",
    "model_type": "a table",
    "string_type": "text",
    "tuple_type": "a list",
}
"""By pydantic's type of a problem, where its own words are not a user's."""


def wording(problem: ErrorDetails) -> str:
    """What a value must be, and what it is instead."""
    kind, said, context = problem["type"], problem["msg"], problem.get("ctx", {})
    if kind == "value_error":
        return str(context["error"])
    if kind in ALLOWED:
        said = INSTEAD + ALLOWED[kind].format(**context)
    if said.startswith(INSTEAD):
        return f"must be {said.removeprefix(INSTEAD)}, not {_short(problem['input'])}"
    return said[0].lower() + said[1:]


def _short(value: object, longest: int = 60) -> str:
    text = repr(value)
    return text if len(text) <= longest else f"{text[:longest]}..."
