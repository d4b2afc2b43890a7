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
from laglab_fmu.foreign.steps import substeps, tolerance

Value = float | bool | str | Sequence[float]
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
    _refuse_twice("inputs", names)
    found = [_found(file, f"inputs.{ours}", theirs) for ours, theirs in names.items()]
    for ours, element in zip(names, found, strict=True):
        variable = element.variable
        settable = variable.causality == "input" or variable.variability == "tunable"
        if not settable or variable.type not in REAL:
            raise WiringError(
                f"inputs.{ours}: {element.name} of {file.path.name} is no real input, but "
                f"{_what(variable)}; its inputs: {_listed(file, 'input')}"
            )
    return found


def output_elements(file: FmuFile, names: Mapping[str, str]) -> list[Element]:
    """What the FMU can be asked. Raises WiringError, naming the key."""
    measured = {ours: theirs for ours, theirs in names.items() if ours.endswith("_meas")}
    _refuse_twice("outputs", measured)  # by itself: a pose may be measured exactly
    _refuse_twice("outputs", {ours: names[ours] for ours in names if ours not in measured})
    found = [_found(file, f"outputs.{ours}", theirs) for ours, theirs in names.items()]
    for ours, element in zip(names, found, strict=True):
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
    return found


def start_elements(file: FmuFile, names: Mapping[str, str]) -> list[Element]:
    """What the FMU can be told of its start. Raises WiringError, naming the key."""
    _refuse_twice("start", names)
    return [_found(file, f"start.{ours}", theirs) for ours, theirs in names.items()]


def _refuse_twice(table: str, names: Mapping[str, str]) -> None:
    """Raises WiringError: one variable cannot be two things."""
    ours: dict[str, str] = {}
    for key, theirs in names.items():
        if first := ours.get(theirs):
            raise WiringError(f"{table}.{key}: {theirs} is {table}.{first} already")
        ours[theirs] = key


def check_parameters(file: FmuFile, values: Mapping[str, Value]) -> None:
    """Raises WiringError: there is no such variable."""
    for name in values:
        _found(file, "parameters", name)


def check(file: FmuFile, wiring: Wiring, sample_time: float) -> None:
    """All that can be known to be wrong before the FMU runs. Raises FmuFileError."""
    if file.interface() == "model exchange":
        tolerance(file)
    substeps(file, sample_time)
    input_elements(file, wiring.inputs)
    output_elements(file, wiring.outputs)
    start_elements(file, wiring.start)
    check_parameters(file, wiring.parameters)


def _found(file: FmuFile, key: str, name: str) -> Element:
    variables = file.variables
    if name in variables:
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
