"""The model's structure in both descriptions: what is unknown, and what it depends on."""

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

from laglab_fmu.models import Role, Variable

_OUTPUTS = (Role.STATE, Role.SAMPLED, Role.ALGEBRAIC)


def _listed(
    names: Sequence[str], numbers: Mapping[str, object], reference: Mapping[str, int]
) -> str:
    """Variables in the order of the table, by the numbers that the version of FMI gives them."""
    return " ".join(str(numbers[name]) for name in sorted(names, key=reference.__getitem__))


def structure_2(
    root: Element,
    variables: list[Variable],
    index: dict[str, str],
    reference: Mapping[str, int],
) -> None:
    """FMI 2.0's, which numbers the variables by their place in the description."""
    structure = SubElement(root, "ModelStructure")
    for group, roles in (("Outputs", _OUTPUTS), ("Derivatives", (Role.DERIVATIVE,))):
        unknowns = SubElement(structure, group)
        for variable in variables:
            if variable.role in roles:
                depends = _listed(variable.depends_on, index, reference)
                attributes = {"index": index[variable.name], "dependencies": depends}
                SubElement(unknowns, "Unknown", attributes)
    initial = SubElement(structure, "InitialUnknowns")
    for variable in variables:
        if variable.role in (*_OUTPUTS, Role.DERIVATIVE):
            depends = _listed(variable.depends_at_start_on, index, reference)
            attributes = {"index": index[variable.name], "dependencies": depends}
            SubElement(initial, "Unknown", attributes)


def structure_3(root: Element, variables: list[Variable], references: Mapping[str, int]) -> None:
    """FMI 3.0's, which goes by value references."""
    structure = SubElement(root, "ModelStructure")
    for group, roles in (("Output", _OUTPUTS), ("ContinuousStateDerivative", (Role.DERIVATIVE,))):
        for variable in variables:
            if variable.role in roles:
                depends = _listed(variable.depends_on, references, references)
                reference = str(references[variable.name])
                SubElement(structure, group, valueReference=reference, dependencies=depends)
    for variable in variables:
        if variable.role in (*_OUTPUTS, Role.DERIVATIVE):
            depends = _listed(variable.depends_at_start_on, references, references)
            reference = str(references[variable.name])
            SubElement(structure, "InitialUnknown", valueReference=reference, dependencies=depends)
