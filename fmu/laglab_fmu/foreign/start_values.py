"""What an FMU is told before it runs: start values, an array's whole, each as its type has it."""

from collections.abc import Sequence

from fmpy.model_description import ModelVariable

from laglab_fmu.errors import FmuFileError, WiringError
from laglab_fmu.foreign.file import FmuFile
from laglab_fmu.foreign.steps import substeps, tolerance
from laglab_fmu.foreign.wiring import (
    REAL,
    Element,
    Scalar,
    Value,
    Wiring,
    input_elements,
    output_elements,
    parameter_elements,
    size,
    start_elements,
)

BITS = {"Integer": 32, "Enumeration": 32, **{f"Int{bits}": bits for bits in (8, 16, 32, 64)}}
RANGES = {
    **{kind: (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for kind, bits in BITS.items()},
    **{f"UInt{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)},
}
"""The smallest and the largest whole number by FMI's type: others would be cut to its bits."""
SWITCH: dict[Value, bool] = {"true": True, "false": False, True: True, False: False}


def check(file: FmuFile, wiring: Wiring, sample_time: float) -> None:
    """All that can be known to be wrong before the FMU runs. Raises FmuFileError."""
    if file.interface() == "model exchange":
        tolerance(file)
    substeps(file, sample_time)
    input_elements(file, wiring.inputs)
    output_elements(file, wiring.outputs)
    start_elements(file, wiring.start)
    parameter_values(file, wiring)


def parameter_values(file: FmuFile, wiring: Wiring) -> dict[str, list[Scalar]]:
    """The wiring's parameters by the FMU's names, with all elements. Raises FmuFileError."""
    elements = parameter_elements(file, wiring.parameters)
    pairs = list(zip(elements, wiring.parameters.values(), strict=True))
    told = {
        element.name: _whole(file, element.variable, value)
        for element, value in pairs
        if not _is_part(element)
    }
    for element, value in pairs:
        if _is_part(element):
            _put(file, "parameters", told, element, value)
    return told


def start_values(file: FmuFile, wiring: Wiring, start: Sequence[float]) -> dict[str, Value]:
    """The parameters, and over them the start, by the FMU's names. Raises FmuFileError."""
    told = parameter_values(file, wiring)
    for (ours, element), number in zip(
        start_elements(file, wiring.start).items(), start, strict=True
    ):
        _put(file, f"start.{ours}", told, element, number)
    variables = file.variables
    return {name: each if variables[name].shape else each[0] for name, each in told.items()}


def starts(variable: ModelVariable) -> list[Scalar]:
    """The values that a variable has at first, as its description says; 0 where it does not.

    Raises FmuFileError: they are none.
    """
    said = str(variable.start or "").split()
    many = size(variable)
    if len(said) == 1:
        said *= many  # FMI 3: one for all
    try:
        numbers = [SWITCH.get(each, each) for each in said]
        return [float(each) for each in numbers] if len(said) == many else [0.0] * many
    except ValueError as error:
        raise FmuFileError(
            f"{variable.name} starts at {variable.start!r}, which is no number: mend that in the "
            "FMU's modelDescription.xml"
        ) from error


def _is_part(element: Element) -> bool:
    return bool(element.name != element.variable.name)


def _put(
    file: FmuFile, key: str, told: dict[str, list[Scalar]], element: Element, value: Value
) -> None:
    variable = element.variable
    if variable.type not in (*REAL, *RANGES, "Boolean"):  # FMPy reads the first start text alone
        raise WiringError(
            f"{key}: {element.name} of {file.path.name} is no number: tell {variable.name} whole"
        )
    values = told.setdefault(variable.name, starts(variable))
    values[element.offset] = _typed(file, key, element.name, variable, value)


def _whole(file: FmuFile, variable: ModelVariable, value: Value) -> list[Scalar]:
    """All elements, of a list, of a text of many words, or of the one that there is."""
    name, many = variable.name, size(variable)
    if not variable.shape:
        return [_typed(file, "parameters", name, variable, value)]
    told = value.split() if isinstance(value, str) else value
    listed = [told] if isinstance(told, int | float) else list(told)
    if len(listed) != many:
        shape = " by ".join(map(str, variable.shape))
        raise WiringError(
            f"parameters: {name} of {file.path.name} has {shape} elements: give a list of {many}, "
            f"not {value!r}, or {name}[0] and others by themselves"
        )
    return [_typed(file, "parameters", name, variable, each) for each in listed]


def _typed(file: FmuFile, key: str, name: str, variable: ModelVariable, value: Value) -> Scalar:
    """The value as FMPy's setter for the type wants it. Raises WiringError, naming the key."""
    kind = variable.type
    try:
        if kind in REAL:
            return float(value)  # type: ignore[arg-type]
        if kind == "Boolean":
            return SWITCH[value.lower() if isinstance(value, str) else value]
        if kind in RANGES:
            return _whole_number(kind, value)
    except (ArithmeticError, LookupError, TypeError, ValueError):
        asked = "true or false" if kind == "Boolean" else "a number"
        if limits := RANGES.get(kind):
            asked = f"a whole number from {limits[0]} to {limits[1]}"
        raise WiringError(
            f"{key}: {name} of {file.path.name} takes {asked}, not {value!r}"
        ) from None
    return str(value)


def _whole_number(kind: str, value: Value) -> int:
    """Raises ValueError and others: it is none, or too large for the type."""
    number = int(value)  # type: ignore[arg-type]
    least, most = RANGES[kind]
    if not least <= number <= most or (number != value and not isinstance(value, str)):
        raise ValueError(value)
    return number
