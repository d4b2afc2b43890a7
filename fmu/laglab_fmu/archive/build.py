"""Building the FMUs from C sources and the table of variables."""

import os
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from laglab_fmu.archive.contents import c_files, fmi_headers, fmu_contents
from laglab_fmu.archive.mach_o import signed, universal
from laglab_fmu.compiler import (
    Platform,
    c_compiler,
    compile_library,
    host_platform,
    zig_compiler,
)
from laglab_fmu.models import MODELS, Model

ZIP_DATE = (1980, 1, 1, 0, 0, 0)
"""The oldest date that a zip can hold: the same for every file of every build."""


def build_fmus(directory: Path, platforms: Sequence[Platform] = ()) -> list[Path]:
    """Builds the FMUs of every robot that ships, of FMI 2 and 3 and of many, in a directory.

    Args:
        directory: where the FMUs go; made if missing.
        platforms: compile for these with ziglang; without any, for this machine alone, with its
            own compiler where it has one.

    Returns:
        The files written. The same compiler gives the same bytes.

    Raises:
        CompilerNotFoundError: there is none; says what to install.
        BuildError: the compiler failed, a source is missing, or no binary is known for here.
        OSError: a file cannot be written; it names it.
    """
    if platforms:
        compilers = {platform: zig_compiler(platform) for platform in platforms}
    else:
        compilers = {host_platform(): c_compiler()}
    built: dict[str, dict[Platform, bytes]] = {}
    for model in MODELS:
        with tempfile.TemporaryDirectory(prefix="laglab-build-") as folder:
            binaries = _compile(model, Path(folder), compilers)
        built |= dict.fromkeys(model.fmus, binaries)
    directory.mkdir(parents=True, exist_ok=True)
    return [
        _write_zip(directory / f"{name}.fmu", fmu_contents(name, binaries))
        for name, binaries in built.items()
    ]


def _compile(
    model: Model, folder: Path, compilers: Mapping[Platform, Sequence[str]]
) -> dict[Platform, bytes]:
    """For each platform a library of both versions of FMI; for macOS one for all processors."""
    for name, text in c_files(model).items():
        (folder / name).write_bytes(text)
    sources = sorted(path.name for path in folder.glob("*.c"))
    binaries = {}
    for platform, compiler in compilers.items():
        library = f"{model.name}{platform.suffix}"
        compile_library(folder, sources, library, compiler, fmi_headers())
        binaries[platform] = (folder / library).read_bytes()
    return binaries | _for_macos(model, binaries)


def _for_macos(model: Model, binaries: Mapping[Platform, bytes]) -> dict[Platform, bytes]:
    """The same signed library for every processor that macOS runs on."""
    parts = {p: signed(code, model.name) for p, code in binaries.items() if p.system == "darwin"}
    if len(parts) < 2:
        return parts
    return dict.fromkeys(parts, universal(list(parts.values())))


def _write_zip(path: Path, files: Mapping[str, bytes]) -> Path:
    """Same files, same bytes: fixed dates, order, permissions and compression. Whole or not at all:
    what is there already may be in use."""
    new = path.with_name(f"{path.stem}-{os.getpid()}.new")  # somebody else may build here too
    try:
        with zipfile.ZipFile(new, "w") as archive:
            for name in sorted(files):
                entry = zipfile.ZipInfo(name, ZIP_DATE)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.create_system = 3
                entry.external_attr = 0o644 << 16
                archive.writestr(entry, files[name])
        return new.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error  # a full disk names none
    finally:
        new.unlink(missing_ok=True)
