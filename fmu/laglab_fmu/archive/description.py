"""Both model descriptions, made from the one table of variables."""

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from laglab_fmu.archive.structure import structure_2, structure_3
from laglab_fmu.models import Kind, Model, Role, Variable, token
from laglab_fmu.models.units import TYPES, UNITS, DeclaredType, Unit
from laglab_fmu.models.variables import START
from laglab_fmu.parameters import INTEGRATIONS

STOP_TIME = 10.0
"""[s] of the default experiment."""
LOG_CATEGORIES = (
    ("logEvents", "Initialization and sample events"),
    ("logStatusDiscard", "Values that were refused"),
    ("logStatusError", "Calls that were wrong"),
)


_CAUSALITY = {
    Role.TIME: "independent",
    Role.ROBOTS: "structuralParameter",
    Role.PARAMETER: "parameter",
    Role.TUNABLE: "parameter",
    Role.INPUT: "input",
    Role.STATE: "output",
    Role.SAMPLED: "output",
    Role.ALGEBRAIC: "output",
    Role.DERIVATIVE: "local",
}
_VARIABILITY = {
    Role.ROBOTS: "fixed",
    Role.PARAMETER: "fixed",
    Role.TUNABLE: "tunable",
    Role.SAMPLED: "discrete",
}
_PARAMETERS = (Role.PARAMETER, Role.TUNABLE)
_HAS_START = (Role.ROBOTS, *_PARAMETERS, Role.INPUT)


def number(value: float) -> str:
    """A number as XML wants it: integers without a point."""
    return str(int(value)) if value == int(value) else repr(value)


DEFAULT_EXPERIMENT = {
    "startTime": "0",
    "stopTime": number(STOP_TIME),
    "tolerance": "1e-6",
    "stepSize": number(START["sample_time"]),
}


def model_description_2(model: Model, sources: Sequence[str]) -> bytes:
    """modelDescription.xml of FMI 2.0: one robot, no `time`, built of these C files."""
    root = Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=model.name,
        guid=token(f"{model.name}2"),
        description=model.description,
        license="MIT",
        generationTool="laglab",
        variableNamingConvention="structured",
        numberOfEventIndicators="0",
    )
    identifier = {"modelIdentifier": model.name}
    for face in ("ModelExchange", "CoSimulation"):
        files = SubElement(
            SubElement(root, face, identifier | _capabilities_2(face)), "SourceFiles"
        )
        for source in sources:
            SubElement(files, "File", name=source)
    _units(root)
    _types_2(root)
    _log_categories(root)
    SubElement(root, "DefaultExperiment", DEFAULT_EXPERIMENT)
    variables = [v for v in model.variables if v.role not in (Role.TIME, Role.ROBOTS)]
    index = {variable.name: str(i + 1) for i, variable in enumerate(variables)}
    element = SubElement(root, "ModelVariables")
    for variable in variables:
        _variable_2(element, variable, index, model.reference)
    structure_2(root, variables, index, model.reference)
    return xml_text(root)


def model_description_3(model: Model, fleet: bool = False) -> bytes:
    """modelDescription.xml of FMI 3.0: one robot, or arrays of `robots`."""
    name = model.fleet if fleet else model.name
    root = Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=name,
        instantiationToken=token(f"{name}3"),
        description=model.description + (", many at once" if fleet else ""),
        license="MIT",
        generationTool="laglab",
        variableNamingConvention="structured",
    )
    for face in ("ModelExchange", "CoSimulation"):
        SubElement(root, face, {"modelIdentifier": name} | _capabilities_3(face))
    _units(root)
    _types_3(root)
    _log_categories(root)
    SubElement(root, "DefaultExperiment", DEFAULT_EXPERIMENT)
    variables = [v for v in model.variables if v.role is not Role.ROBOTS]
    if fleet:  # first, for importers that follow dimensions while they read
        variables.insert(0, model.variables[model.reference["robots"]])
    element = SubElement(root, "ModelVariables")
    for variable in variables:
        _variable_3(element, variable, fleet, model.reference)
    structure_3(root, variables, model.reference)
    return xml_text(root)


def _capabilities_2(face: str) -> dict[str, str]:
    names = (
        "canNotUseMemoryManagementFunctions",
        "canGetAndSetFMUstate",
        "canSerializeFMUstate",
        "providesDirectionalDerivative",
    )
    return _capabilities(face, names)


def _capabilities_3(face: str) -> dict[str, str]:
    names = (
        "canGetAndSetFMUState",
        "canSerializeFMUState",
        "providesDirectionalDerivatives",
        "providesAdjointDerivatives",
    )
    in_a_step = (
        "providesIntermediateUpdate",
        "mightReturnEarlyFromDoStep",
        "canReturnEarlyAfterIntermediateUpdate",
        "hasEventMode",
    )
    return _capabilities(face, names if face == "ModelExchange" else (*names, *in_a_step))


def _capabilities(face: str, names: tuple[str, ...]) -> dict[str, str]:
    if face == "CoSimulation":
        names = (*names, "canHandleVariableCommunicationStepSize")
    return dict.fromkeys(names, "true")


def _units(root: Element) -> None:
    definitions = SubElement(root, "UnitDefinitions")
    for unit in UNITS:
        element = SubElement(definitions, "Unit", name=unit.name)
        SubElement(element, "BaseUnit", {base: str(power) for base, power in unit.powers})
        if unit.display:
            name, factor = unit.display
            SubElement(element, "DisplayUnit", name=name, factor=repr(factor))


def _types_2(root: Element) -> None:
    definitions = SubElement(root, "TypeDefinitions")
    for declared in TYPES:
        attributes = {"name": declared.name, "description": declared.description}
        simple = SubElement(definitions, "SimpleType", attributes)
        SubElement(simple, "Real", _type_attributes(declared))
    simple = SubElement(definitions, "SimpleType", name="Integration")
    _items(SubElement(simple, "Enumeration"))


def _types_3(root: Element) -> None:
    definitions = SubElement(root, "TypeDefinitions")
    for declared in TYPES:
        attributes = {"name": declared.name, "description": declared.description}
        SubElement(definitions, "Float64Type", attributes | _type_attributes(declared))
    _items(SubElement(definitions, "EnumerationType", name="Integration"))


def _type_attributes(declared: DeclaredType) -> dict[str, str]:
    unit = _unit(declared)
    attributes = {"quantity": declared.quantity, "unit": unit.name}
    return attributes | ({"displayUnit": unit.display[0]} if unit.display else {})


def _unit(declared: DeclaredType) -> Unit:
    return next(unit for unit in UNITS if unit.name == declared.unit)


def _items(enumeration: Element) -> None:
    for value, (name, description) in enumerate(INTEGRATIONS, start=1):
        SubElement(enumeration, "Item", name=name, value=str(value), description=description)


def _log_categories(root: Element) -> None:
    categories = SubElement(root, "LogCategories")
    for name, description in LOG_CATEGORIES:
        SubElement(categories, "Category", name=name, description=description)


def _variability(variable: Variable) -> str:
    return _VARIABILITY.get(variable.role, "continuous")


def _bounds(variable: Variable) -> dict[str, str]:
    if variable.kind is Kind.BOOLEAN:
        return {}
    bounds = {"min": variable.minimum, "max": variable.maximum, "nominal": variable.nominal}
    return {name: number(value) for name, value in bounds.items() if value is not None}


def _start(variable: Variable) -> dict[str, str]:
    if variable.role not in _HAS_START:
        return {}
    if variable.kind is Kind.BOOLEAN:
        return {"start": "true" if variable.start else "false"}
    return {"start": number(variable.start)}


def _common(variable: Variable, reference: Mapping[str, int]) -> dict[str, str]:
    attributes = {
        "name": variable.name,
        "valueReference": str(reference[variable.name]),
        "causality": _CAUSALITY[variable.role],
        "variability": _variability(variable),
        "description": variable.description,
    }
    if variable.role in _PARAMETERS:
        attributes["initial"] = "exact"
    elif variable.role not in (Role.TIME, Role.INPUT, Role.ROBOTS):
        attributes["initial"] = "calculated"
    return attributes


def _variable_2(
    model: Element, variable: Variable, index: dict[str, str], reference: Mapping[str, int]
) -> None:
    scalar = SubElement(model, "ScalarVariable", _common(variable, reference))
    attributes = _bounds(variable) | _start(variable)
    if variable.declared_type:
        attributes["declaredType"] = variable.declared_type
    if variable.state:
        attributes["derivative"] = index[variable.state]
    kind = {Kind.FLOAT64: "Real", Kind.INT32: "Integer"}.get(variable.kind, variable.kind.value)
    SubElement(scalar, kind, attributes)


def _variable_3(
    model: Element, variable: Variable, fleet: bool, reference: Mapping[str, int]
) -> None:
    attributes = _common(variable, reference) | _bounds(variable) | _start(variable)
    if variable.declared_type:
        attributes["declaredType"] = variable.declared_type
    if variable.state:
        attributes["derivative"] = str(reference[variable.state])
    if _CAUSALITY[variable.role] == "output":
        attributes["intermediateUpdate"] = "true"
    element = SubElement(model, variable.kind.value, attributes)
    if fleet and variable.role not in (Role.TIME, Role.ROBOTS):
        SubElement(element, "Dimension", valueReference=str(reference["robots"]))


def xml_text(root: Element) -> bytes:
    """An XML document, indented."""
    ElementTree.indent(root)
    text: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text + b"\n"
