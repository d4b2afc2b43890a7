"""The model's structure in both descriptions: what is unknown, and what it depends on."""

from collections.abc import Iterable, Mapping
from xml.etree.ElementTree import Element, SubElement

from laglab_fmu.models import Role, Variable

_OUTPUTS = {Role.STATE, Role.SAMPLED, Role.ALGEBRAIC}
_DERIVATIVES = {Role.DERIVATIVE}


def structure_2(
    root: Element,
    variables: Iterable[Variable],
    index: Mapping[str, str],
    reference: Mapping[str, int],
) -> None:
    """Adds that of FMI 2.0, which numbers the variables by their place in the description."""

    def tell(group: str, roles: set[Role], at_start: bool = False) -> None:
        unknowns = SubElement(structure, group)
        for variable in variables:
            if variable.role in roles:
                names = variable.depends_at_start_on if at_start else variable.depends_on
                depends = " ".join(index[each] for each in sorted(names, key=reference.__getitem__))
                attributes = {"index": index[variable.name], "dependencies": depends}
                SubElement(unknowns, "Unknown", attributes)

    structure = SubElement(root, "ModelStructure")
    tell("Outputs", _OUTPUTS)
    tell("Derivatives", _DERIVATIVES)
    tell("InitialUnknowns", _OUTPUTS | _DERIVATIVES, at_start=True)


def structure_3(root: Element, variables: Iterable[Variable], reference: Mapping[str, int]) -> None:
    """Adds that of FMI 3.0, which goes by value references."""

    def tell(group: str, roles: set[Role], at_start: bool = False) -> None:
        for variable in variables:
            if variable.role in roles:
                names = variable.depends_at_start_on if at_start else variable.depends_on
                depends = " ".join(map(str, sorted(reference[each] for each in names)))
                attributes = {"valueReference": str(reference[variable.name])}
                SubElement(structure, group, attributes | {"dependencies": depends})

    structure = SubElement(root, "ModelStructure")
    tell("Output", _OUTPUTS)
    tell("ContinuousStateDerivative", _DERIVATIVES)
    tell("InitialUnknown", _OUTPUTS | _DERIVATIVES, at_start=True)
