"""What lies in an FMU: descriptions, binaries, sources, documentation, icon, terminals, results."""

import html
from collections.abc import Mapping
from importlib.metadata import distribution
from pathlib import Path
from string import Template
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import fmpy

from laglab_fmu.archive.description import model_description_2, model_description_3, xml_text
from laglab_fmu.archive.header import variables_header
from laglab_fmu.compiler import Platform
from laglab_fmu.errors import BuildError
from laglab_fmu.models import ROBOT, Model, Role, Variable, model_of, token
from laglab_fmu.models.units import TYPES

HEADERS = {
    2: ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"),
    3: ("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h"),
}
TERMINALS = (
    ("commands", "What the robot is told", Role.INPUT),
    ("pose", "Where the robot is", Role.STATE),
    ("sensor", "What the sensor says of the pose", Role.SAMPLED),
    ("body", "Speeds of the body", Role.ALGEBRAIC),
)
REFERENCE_LAYER = "org.fmi-standard.fmi-ls-ref"
_LAYER_NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"


def own_files(folder: str) -> Path:
    """A folder of this component: inside an installed package, or beside it in the repository.

    Raises:
        BuildError: in neither place.
    """
    package = Path(__file__).parents[1]
    for place in (package / folder, package.parent / folder):
        if place.is_dir():
            return place
    raise BuildError(f"there is no {folder} in {package} or beside it; install laglab again")


def c_files(model: Model = ROBOT) -> dict[str, bytes]:
    """The C sources of both versions by name, with the generated header. Raises BuildError."""
    src = own_files("src")
    folders = src, src / "faces", src / "robots" / model.folder
    files = {
        path.name: path.read_bytes() for each in folders for path in sorted(each.glob("*.[ch]"))
    }
    tokens = dict(zip(("TOKEN_2", "TOKEN_3", "TOKEN_FLEET"), map(token, model.fmus), strict=True))
    return files | {"variables.h": variables_header(model.variables, tokens).encode()}


def fmi_headers() -> Path:
    """The folder of the FMI 2.0 and 3.0 headers, which the installed fmpy carries."""
    return Path(fmpy.__file__).parent / "c-code"


def fmu_contents(name: str, binaries: Mapping[Platform, bytes]) -> dict[str, bytes]:
    """All files of an FMU, such as Robot2, by their path in the archive.

    Raises:
        BuildError: a source, or the licence of the headers, is missing.
    """
    identifier, version = name[:-1], int(name[-1])
    model = model_of(name)
    sources = _sources(model, version)
    names = sorted(source for source in sources if source.endswith(".c"))
    files = {f"sources/{source}": text for source, text in sources.items()}
    if version == 2:
        files["modelDescription.xml"] = model_description_2(model, names)
    else:
        files["modelDescription.xml"] = model_description_3(model, fleet=identifier == model.fleet)
        files["sources/buildDescription.xml"] = _build_description(identifier, names)
    for platform, library in binaries.items():
        folder = platform.fmi2_folder if version == 2 else platform.fmi3_folder
        files[f"binaries/{folder}/{identifier}{platform.suffix}"] = library
    files |= _documentation(model) | _icons(model, version)
    return files | _reference_results(identifier) if model is ROBOT else files


def _sources(model: Model, version: int) -> dict[str, bytes]:
    """The sources of one version, with the headers that they include."""
    other = f"fmi{5 - version}"
    ours = {name: text for name, text in c_files(model).items() if not name.startswith(other)}
    return ours | {name: (fmi_headers() / name).read_bytes() for name in HEADERS[version]}


def _build_description(identifier: str, sources: list[str]) -> bytes:
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    build = SubElement(root, "BuildConfiguration", modelIdentifier=identifier)
    files = SubElement(build, "SourceFileSet", language="C99")
    for source in sources:
        SubElement(files, "SourceFile", name=source)
    SubElement(
        build, "Library", name="m", external="true", description="The C library's mathematics"
    )
    return xml_text(root)


def _documentation(model: Model) -> dict[str, bytes]:
    content = own_files("content")
    page = Template((content / "index.html").read_text(encoding="utf-8"))
    motion = (content / "robots" / f"{model.folder}.html").read_text(encoding="utf-8")
    rows = "\n".join(
        _row(variable) for variable in model.variables if variable.role is not Role.TIME
    )
    return {
        "documentation/index.html": page.substitute(
            name=model.name,
            description=model.description,
            motion=motion.rstrip(),
            fleet=model.fleet,
            rows=rows,
        ).encode(),
        "documentation/licenses/license.txt": (content / "license.txt").read_bytes(),
        "documentation/licenses/fmi-headers.txt": _header_licence(),
    }


def _row(variable: Variable) -> str:
    unit = next((t.unit for t in TYPES if t.name == variable.declared_type), "")
    start = repr(variable.start) if variable.role in (Role.PARAMETER, Role.TUNABLE) else ""
    cells = (variable.name, unit, variable.role.value, start, variable.description)
    return "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>"


def _header_licence() -> bytes:
    files = distribution("fmpy").files or []
    texts = [file for file in files if file.name.startswith("LICENSE")]
    if not texts:
        raise BuildError("the installed fmpy has no licence file to put beside its FMI headers")
    return Path(str(texts[0].locate())).read_bytes()


def _icons(model: Model, version: int) -> dict[str, bytes]:
    content = own_files("content")
    icon = (content / "icon.png").read_bytes()
    if version == 2:
        return {"model.png": icon}
    return {
        "terminalsAndIcons/icon.png": icon,
        "terminalsAndIcons/icon.svg": (content / "icon.svg").read_bytes(),
        "terminalsAndIcons/terminalsAndIcons.xml": _terminals(model),
    }


def _terminals(model: Model) -> bytes:
    root = Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    box = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    graphics = SubElement(root, "GraphicalRepresentation")
    SubElement(graphics, "CoordinateSystem", box | {"suggestedScalingFactorTo_mm": "0.1"})
    SubElement(graphics, "Icon", box)
    terminals = SubElement(root, "Terminals")
    for name, description, role in TERMINALS:
        attributes = {"name": name, "matchingRule": "plug", "description": description}
        terminal = SubElement(terminals, "Terminal", attributes)
        for variable in model.variables:
            if variable.role is role:
                attributes = {"variableName": variable.name, "memberName": variable.name}
                SubElement(terminal, "TerminalMemberVariable", attributes, variableKind="signal")
    return xml_text(root)


def _reference_results(identifier: str) -> dict[str, bytes]:
    """Inputs of the default experiment and the answers; a fleet is one robot by default."""
    ElementTree.register_namespace("fmi-ls", _LAYER_NAMESPACE)
    layer = {
        "fmi-ls-name": REFERENCE_LAYER,
        "fmi-ls-version": "1.0.0-alpha.1",
        "fmi-ls-description": "Reference results of the default experiment",
    }
    root = Element(
        "fmiReferences", {f"{{{_LAYER_NAMESPACE}}}{key}": value for key, value in layer.items()}
    )
    files = {}
    for end, role, description in (
        ("in", "input", "Wheel speeds of the default experiment"),
        ("out", "result", "Output of the default experiment in co-simulation"),
    ):
        name = f"{identifier}_{end}.csv"
        attributes = {"type": "text/csv", "source": name, "role": role}
        SubElement(root, "Related", attributes, description=description)
        files[f"extra/{REFERENCE_LAYER}/{name}"] = (
            own_files("content") / f"{ROBOT.name}_{end}.csv"
        ).read_bytes()
    return files | {f"extra/{REFERENCE_LAYER}/fmi-ls-manifest.xml": xml_text(root)}
