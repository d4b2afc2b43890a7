"""Building the FMUs from C sources and the table of variables.

The FMI headers come from the installed fmpy package (BSD-2-Clause); its licence goes into the FMU.
"""

import tempfile
import zipfile
from collections.abc import Mapping
from importlib.metadata import distribution
from pathlib import Path

import fmpy

from laglab_fmu.compiler import (
    Platform,
    compile_library,
    host_platform,
    zig_compiler,
)
from laglab_fmu.description import TOKEN, model_description_2, model_description_3
from laglab_fmu.errors import BuildError
from laglab_fmu.header import variables_header
from laglab_fmu.host import host_compiler
from laglab_fmu.variables import MODEL_NAME

ZIP_DATE = (1980, 1, 1, 0, 0, 0)
"""The oldest date that a zip can hold: the same for every file of every build."""


def build_fmus(directory: Path, compiler: list[str] | None = None) -> list[Path]:
    """Builds Robot2.fmu and Robot3.fmu into a directory, for this machine.

    Args:
        directory: where the FMUs go; made if missing.
        compiler: command of a C compiler; else the host's, else ziglang's.

    Returns:
        The files written. The same compiler gives the same bytes.

    Raises:
        CompilerNotFoundError: there is none; says what to install.
        BuildError: the compiler failed, or a source is missing.
    """
    platform = host_platform()
    compiler = compiler or host_compiler() or zig_compiler(platform)
    with tempfile.TemporaryDirectory(prefix="laglab-build-") as folder:
        sources = Path(folder, "sources")
        write_sources(sources)
        library = Path(folder, MODEL_NAME + platform.suffix)
        compile_library(sorted(sources.glob("*.c")), [fmi_headers()], library, compiler)
        binaries = {platform: library.read_bytes()}
    directory.mkdir(parents=True, exist_ok=True)
    contents = {
        "Robot2.fmu": _contents_2(binaries),
        "Robot3.fmu": _contents_3(binaries),
    }
    return [_write_zip(directory / name, files) for name, files in contents.items()]


def source_directory() -> Path:
    """Where the C sources lie: inside an installed package, or beside it in the repository.

    Raises:
        BuildError: in neither place.
    """
    package = Path(__file__).parent
    for place in (package / "src", package.parent / "src"):
        if (place / "robot.c").is_file():
            return place
    raise BuildError(
        f"the FMU's C sources are neither in {package} nor beside it; install laglab again"
    )


def fmi_headers() -> Path:
    """The folder of the FMI 2.0 and 3.0 headers."""
    return Path(fmpy.__file__).parent / "c-code"


def write_sources(directory: Path) -> None:
    """Writes all C sources of the FMU, the generated header included, into a new directory."""
    directory.mkdir(parents=True)
    for source in sorted(source_directory().glob("*.[ch]")):
        (directory / source.name).write_bytes(source.read_bytes())
    (directory / "variables.h").write_text(variables_header(TOKEN), encoding="utf-8", newline="\n")


def _licences() -> dict[str, bytes]:
    """Licences of what the binary and the sources hold that is not ours: the FMI headers."""
    files = distribution("fmpy").files or []
    texts = [file for file in files if file.name.startswith("LICENSE")]
    if not texts:
        raise BuildError("the installed fmpy has no licence file to put beside its FMI headers")
    return {"documentation/licenses/fmi-headers.txt": Path(str(texts[0].locate())).read_bytes()}


def _contents_2(binaries: Mapping[Platform, bytes]) -> dict[str, bytes]:
    files = {"modelDescription.xml": model_description_2()} | _licences()
    for platform, library in binaries.items():
        files[f"binaries/{platform.fmi2_folder}/{MODEL_NAME}{platform.suffix}"] = library
    return files


def _contents_3(binaries: Mapping[Platform, bytes]) -> dict[str, bytes]:
    files = {"modelDescription.xml": model_description_3()} | _licences()
    for platform, library in binaries.items():
        files[f"binaries/{platform.fmi3_folder}/{MODEL_NAME}{platform.suffix}"] = library
    return files


def _write_zip(path: Path, files: Mapping[str, bytes]) -> Path:
    """Same files, same bytes: fixed dates, order, permissions and compression."""
    with zipfile.ZipFile(path, "w") as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, ZIP_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, files[name])
    return path
