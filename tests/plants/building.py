"""Other people's robots, built as they would build them: in C, and with PythonFMU."""

import subprocess
import sys
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from xml.sax.saxutils import quoteattr

from laglab_fmu import c_compiler
from laglab_fmu.archive.contents import fmi_headers
from laglab_fmu.compiler import compile_library, host_platform

SOURCES = Path(__file__).parent / "fmus"
ROVER = (
    *(("drive.cmd_left", "input"), ("drive.cmd_right", "input")),
    *(("posX", "output"), ("posY", "output"), ("psi", "output")),
    *(("posX_0", "parameter"), ("posY_0", "parameter"), ("psi_0", "parameter")),
    *(("gps.x", "output"), ("gps.y", "output"), ("compass", "output")),
    *(("fail_at", "parameter"), ("nan_at", "parameter"), ("discard_at", "parameter")),
    *(("wheel.radius", "parameter"), ("wheel.base", "parameter")),
    *(("crash_at", "parameter"), ("dice", "parameter"), ("wall_at", "parameter")),
    ("hang_at", "parameter"),
    *(("der(posX)", "local"), ("der(posY)", "local"), ("der(psi)", "local")),
)
"""The rover's variables, in the order of their value references."""
STARTS = {
    "wall_at": 1e9,
    "hang_at": 1e9,
    "crash_at": 1e9,
    "wheel.radius": 0.05,
    "wheel.base": 0.6,
    "fail_at": 1e9,
    "nan_at": 1e9,
    "discard_at": 1e9,
}
CO_SIMULATION = (
    '<CoSimulation modelIdentifier="rover" canHandleVariableCommunicationStepSize="true"/>'
)
FIXED_STEP = '<CoSimulation modelIdentifier="rover"/>'
MODEL_EXCHANGE = '<ModelExchange modelIdentifier="rover"/>'
ROVER_MAP = """
inputs = { omega_left = "drive.cmd_left", omega_right = "drive.cmd_right" }
outputs = { x = "posX", y = "posY", theta = "psi" }
start = { x = "posX_0", y = "posY_0", theta = "psi_0" }
"""


def rover_library(folder: Path) -> Path:
    """Compiled there."""
    for name in ("rover.c", "rover_absent.c"):
        (folder / name).write_bytes((SOURCES / name).read_bytes())
    library = f"rover{host_platform().suffix}"
    sources = ["rover.c", "rover_absent.c"]
    compile_library(folder, sources, library, c_compiler(), fmi_headers())
    return folder / library


def rover(
    path: Path,
    library: Path,
    interfaces: Sequence[str] = (CO_SIMULATION,),
    platform: str = host_platform().fmi2_folder,
    resources: Sequence[str] = ("gain.txt",),
    names: Mapping[str, str] = MappingProxyType({}),
    experiment: Mapping[str, str] = MappingProxyType({"stepSize": "0.005"}),
) -> Path:
    """The rover as an FMU; `names` are others than its own."""
    description = rover_description(interfaces, experiment)
    for name, other in names.items():
        description = description.replace(quoteattr(name), quoteattr(other))
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, f"binaries/{platform}/rover{library.suffix}")
        for name in resources:
            archive.writestr(f"resources/{name}", "1.0")
    return path


def rover_description(interfaces: Sequence[str], experiment: Mapping[str, str]) -> str:
    lines = [_variable(i, *each) for i, each in enumerate(ROVER)]
    outputs = [i + 1 for i, (_, causality) in enumerate(ROVER) if causality == "output"]
    derivatives = [i + 1 for i, (name, _) in enumerate(ROVER) if name.startswith("der(")]
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Rover" guid="rover" numberOfEventIndicators="1">
{"".join(interfaces)}
<DefaultExperiment {" ".join(f'{key}="{told}"' for key, told in experiment.items())}/>
<ModelVariables>{"".join(lines)}</ModelVariables>
<ModelStructure>
<Outputs>{_unknowns(outputs)}</Outputs>
<Derivatives>{_unknowns(derivatives)}</Derivatives>
<InitialUnknowns>{_unknowns([*outputs, *derivatives])}</InitialUnknowns>
</ModelStructure>
</fmiModelDescription>"""


def _variable(reference: int, name: str, causality: str) -> str:
    start = f' start="{STARTS.get(name, 0.0)}"' if causality in ("input", "parameter") else ""
    fixed = ' variability="fixed"' if causality == "parameter" else ""
    of = ("posX", "posY", "psi").index(name[4:-1]) + 3 if name.startswith("der(") else 0
    derivative = f' derivative="{of}"' if of else ""
    return (
        f'<ScalarVariable name={quoteattr(name)} valueReference="{reference}" '
        f'causality="{causality}"{fixed}><Real{start}{derivative}/></ScalarVariable>'
    )


def _unknowns(indices: Sequence[int]) -> str:
    return "".join(f'<Unknown index="{i}"/>' for i in indices)


def in_python(module: str, name: str, folder: Path) -> Path:
    """One of ours by PythonFMU: pythonfmu for FMI 2, pythonfmu3 for FMI 3."""
    script = SOURCES / f"{name}.py"
    command = [sys.executable, "-m", module, "build", "-f", str(script), "-d", str(folder)]
    subprocess.run(command, check=True, capture_output=True)
    return folder / f"{name.capitalize()}.fmu"
