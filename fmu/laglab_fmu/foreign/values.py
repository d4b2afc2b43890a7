"""Reading and writing some of an FMU's numbers, by FMPy's own getters and setters."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from fmpy.model_description import ModelVariable

from laglab_fmu.foreign.start_values import starts
from laglab_fmu.foreign.wiring import Element, Scalar, size

ENUMERATION = {2: "Integer", 3: "Int64"}
"""By the version of FMI: enumerations have no getter of their own."""


class _Group(NamedTuple):
    """The variables of one type, which one call can get or set."""

    type: str
    variables: list[ModelVariable]

    @property
    def references(self) -> list[int]:
        return [variable.valueReference for variable in self.variables]

    @property
    def size(self) -> int:
        return sum(map(size, self.variables))

    @property
    def names(self) -> str:
        return ", ".join(variable.name for variable in self.variables)

    def place(self, element: Element) -> int:
        """Where an element is among the values of all the variables."""
        before = self.variables[: self.variables.index(element.variable)]
        return sum(map(size, before)) + element.offset


def _groups(elements: Sequence[Element], version: int) -> list[_Group]:
    kinds: dict[str, list[ModelVariable]] = {}
    for element in elements:
        variable = element.variable
        kind = ENUMERATION[version] if variable.type == "Enumeration" else variable.type
        of_kind = kinds.setdefault(kind, [])
        if variable not in of_kind:
            of_kind.append(variable)
    return [_Group(*each) for each in kinds.items()]


class Reader:
    """Reads elements, in their order."""

    def __init__(self, fmu: Any, version: int, elements: Sequence[Element]) -> None:
        self.variables: dict[str, str] = {}
        """FMI function → whose values it gets: a call that fails tells no more than its name."""
        self._calls = []
        self._places = [(0, 0)] * len(elements)
        for number, group in enumerate(_groups(elements, version)):
            many = () if version == 2 else (group.size,)
            self._calls.append((getattr(fmu, f"get{group.type}"), group.references, many))
            self.variables[f"fmi{version}Get{group.type}"] = group.names
            for i, element in enumerate(elements):
                if element.variable in group.variables:
                    self._places[i] = number, group.place(element)

    def read(self) -> tuple[float, ...]:
        """The elements' values. Raises FMICallException."""
        got = [get(references, *many) for get, references, many in self._calls]
        return tuple(float(got[group][place]) for group, place in self._places)


class Writer:
    """Writes elements, in their order; other elements of an array keep their start value."""

    def __init__(
        self, fmu: Any, version: int, elements: Sequence[Element], told: Mapping[str, list[Scalar]]
    ) -> None:
        self.variables: dict[str, str] = {}
        """FMI function → whose values it sets."""
        self._calls = []
        for group in _groups(elements, version):
            whole = (told.get(each.name) or starts(each) for each in group.variables)
            values = [value for each in whole for value in each]
            places = [
                (i, group.place(element))
                for i, element in enumerate(elements)
                if element.variable in group.variables
            ]
            put = getattr(fmu, f"set{group.type}")
            self._calls.append((put, group.references, values, places))
            self.variables[f"fmi{version}Set{group.type}"] = group.names

    def write(self, numbers: Sequence[float]) -> None:
        """Sets the elements to these. Raises FMICallException."""
        for put, references, values, places in self._calls:
            for i, place in places:
                values[place] = numbers[i]
            put(references, values)
