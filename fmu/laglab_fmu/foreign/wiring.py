"""Which variables of an FMU are whose: names, looked up before anything runs."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from math import prod
from typing import NamedTuple

from fmpy.model_description import ModelVariable

from laglab_fmu.errors import WiringError
from laglab_fmu.foreign.file import FmuFile

Scalar = float | bool | str
Value = Scalar | Sequence[Scalar]
"""A parameter's; whole numbers too."""
REAL = ("Real", "Float64", "Float32")
NUMBERS = (*REAL, "Integer", "Enumeration", "Boolean")
LIKE = 0.5
"""How much alike two names must be (difflib's ratio) for one to be taken for the other."""
ELEMENT = re.compile(r"(.+)\[\s*(\d+(?:\s*,\s*\d+)*)\s*\]")


@dataclass(frozen=True)
class Wiring:
    """Our names → the FMU's; an element of an FMI 3 array is `NAME[0]`, or `NAME[0,2]`."""

    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    start: Mapping[str, str] = field(default_factory=dict)
    parameters: Mapping[str, Value] = field(default_factory=dict)
    """The FMU's own names → their values."""


class Element(NamedTuple):
    """A number in an FMU: a scalar variable, or an element of an array, counted in C's order."""

    name: str
    variable: ModelVariable
    offset: int = 0


def size(variable: ModelVariable) -> int:
    """How many numbers a variable holds: a scalar 1."""
    return prod(variable.shape or ())


def input_elements(file: FmuFile, names: Mapping[str, str]) -> list[Element]:
    """What the FMU can be told while it runs. Raises WiringError, naming the key."""
    found = _all_found(file, "inputs", names)
    _refuse_twice("inputs", found)
    for ours, element in found.items():
        variable = element.variable
        settable = variable.causality == "input" or variable.variability == "tunable"
        if not settable or variable.type not in REAL:
            raise WiringError(
                f"inputs.{ours}: {element.name} of {file.path.name} is no real input, but "
                f"{_what(variable)}; its inputs: {_listed(file, 'input')}"
            )
    return list(found.values())


def output_elements(file: FmuFile, names: Mapping[str, str]) -> list[Element]:
    """What the FMU can be asked. Raises WiringError, naming the key."""
    found = _all_found(file, "outputs", names)
    measured = {ours: each for ours, each in found.items() if ours.endswith("_meas")}
    _refuse_twice("outputs", measured)  # by itself: a pose may be measured exactly
    _refuse_twice("outputs", {ours: found[ours] for ours in found if ours not in measured})
    for ours, element in found.items():
        kind = element.variable.type
        if element.variable.causality == "input":
            raise WiringError(
                f"outputs.{ours}: {element.name} of {file.path.name} is an input; its outputs: "
                f"{_listed(file, 'output')}"
            )
        if kind not in NUMBERS and not kind.lstrip("U").startswith("Int"):
            raise WiringError(
                f"outputs.{ours}: {element.name} of {file.path.name} is no number, but "
                f"{_what(element.variable)}; its outputs: {_listed(file, 'output')}"
            )
    return list(found.values())


def start_elements(file: FmuFile, names: Mapping[str, str]) -> dict[str, Element]:
    """What the FMU can be told of its start. Raises WiringError, naming the key."""
    found = _all_found(file, "start", names)
    _refuse_twice("start", found)
    for ours, element in found.items():
        _refuse_sizes(file, f"start.{ours}", element)
    return found


def parameter_elements(file: FmuFile, values: Mapping[str, Value]) -> list[Element]:
    """What the FMU can be told before it starts. Raises WiringError, naming the key."""
    found = [_found(file, "parameters", name) for name in values]
    for element in found:
        _refuse_sizes(file, "parameters", element)
    return found


def _refuse_sizes(file: FmuFile, key: str, element: Element) -> None:
    """Raises WiringError: what sizes arrays stays as it is, the arrays are read and set by it."""
    if element.variable.causality == "structuralParameter":
        raise WiringError(
            f"{key}: {element.name} of {file.path.name} is a structural parameter, which sizes "
            f"arrays, and stays at {element.variable.start}: export the FMU with another"
        )


def _refuse_twice(table: str, found: Mapping[str, Element]) -> None:
    """Raises WiringError: one variable cannot be two things."""
    ours: dict[tuple[str, int], str] = {}
    for key, element in found.items():
        place = element.variable.name, element.offset
        if first := ours.get(place):
            raise WiringError(f"{table}.{key}: {element.name} is {table}.{first} already")
        ours[place] = key


def _all_found(file: FmuFile, table: str, names: Mapping[str, str]) -> dict[str, Element]:
    return {ours: _found(file, f"{table}.{ours}", theirs) for ours, theirs in names.items()}


def _found(file: FmuFile, key: str, name: str) -> Element:
    variables = file.variables
    if name in variables:
        if size(variables[name]) == 0:
            raise WiringError(f"{key}: {name} of {file.path.name} is an array without elements")
        if size(variables[name]) > 1 and key != "parameters":
            last = ",".join(str(each - 1) for each in variables[name].shape)
            raise WiringError(
                f"{key}: {name} of {file.path.name} is an array: take one of {name}[0] to "
                f"{name}[{last}]"
            )
        return Element(name, variables[name])
    split = ELEMENT.fullmatch(name)
    if split and (array := variables.get(split[1])) is not None and array.shape:
        indices = [int(each) for each in split[2].split(",")]
        place = _place(indices, array.shape)
        if place is None:
            shape = " by ".join(map(str, array.shape))
            raise WiringError(
                f"{key}: {name}: {split[1]} of {file.path.name} has {shape} elements, "
                "counted from 0"
            )
        return Element(name, array, place)
    raise WiringError(f"{key}: {file.path.name} has no variable {name!r}; {_near(file, name)}")


def _place(indices: Sequence[int], shape: Sequence[int]) -> int | None:
    """In C's order; one index alone counts through all of them."""
    shape = [prod(shape)] if len(indices) == 1 else shape
    if len(indices) != len(shape) or any(i >= n for i, n in zip(indices, shape, strict=True)):
        return None
    place = 0
    for index, length in zip(indices, shape, strict=True):
        place = place * length + index
    return place


def _near(file: FmuFile, name: str, most: int = 3) -> str:
    """What may have been meant; else what there is."""
    folded = {each.casefold(): each for each in file.variables}
    alike = [folded[each] for each in get_close_matches(name.casefold(), folded, most, LIKE)]
    if alike:
        return f"did you mean {' or '.join(alike)}?"
    return f"its inputs: {_listed(file, 'input')}; its outputs: {_listed(file, 'output')}"


def _listed(file: FmuFile, causality: str, most: int = 12) -> str:
    names = [each.name for each in file.variables.values() if each.causality == causality]
    return ", ".join(names[:most]) + (", ..." if len(names) > most else "") or "none"


def _what(variable: ModelVariable) -> str:
    return f"{variable.causality or 'local'} {variable.type}"
