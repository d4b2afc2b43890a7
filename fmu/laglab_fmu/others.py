"""What the other robots that ship are told before they start."""

from collections.abc import Mapping
from dataclasses import dataclass

from laglab_fmu.errors import CallError
from laglab_fmu.models import Kind, model_named
from laglab_fmu.parameters import LARGEST_SEED

LARGEST = 1e300


@dataclass(frozen=True)
class OtherParameters:
    """Parameters of one robot of the named model, by its FMU's names, SI units."""

    model: str
    named: Mapping[str, object]
    """What is not here has the model's own start value."""

    @property
    def sample_time(self) -> float:
        """[s]. Raises as `by_name`."""
        return self.by_name()["sample_time"]

    def by_name(self) -> Mapping[str, float]:
        """All of them, as numbers.

        Raises:
            ValueError: no robot that ships is called so.
            CallError: it has no parameter of that name, or it cannot have that value.
        """
        model = model_named(self.model)
        if unknown := self.named.keys() - model.start.keys():
            raise CallError(f"{self.model} has no parameter {', '.join(sorted(unknown))}")
        kinds = {name: model.variables[model.reference[name]].kind for name in self.named}
        named = {name: _number(name, kinds[name], value) for name, value in self.named.items()}
        return {**model.start, **named}


def _number(name: str, kind: Kind, value: object) -> float:
    if not isinstance(value, int | float) or abs(value) > LARGEST:
        raise CallError(f"{name} = {value!r} refused: it is no number, or too large")
    if kind is Kind.FLOAT64:
        return value
    if not float(value).is_integer() or abs(value) > LARGEST_SEED:
        raise CallError(f"{name} = {value} refused: it is no whole number, or too large")
    return int(value)
