"""C to compare with, compiled on the spot as the FMUs are."""

import ctypes
import shutil
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

from laglab_fmu import c_compiler, compile_library, host_platform


def new_folder(stack: ExitStack) -> Path:
    """An empty one, gone when the stack is closed."""
    return Path(stack.enter_context(TemporaryDirectory(prefix="laglab-c-")))


def c_library(
    source: Path, beside: Mapping[str, bytes], stack: ExitStack, headers: Path | None = None
) -> ctypes.CDLL:
    """A C file as a library, with the files `beside` it; loaded.

    `headers` is a folder of other people's.

    Raises:
        BuildError: it does not compile.
        CompilerNotFoundError: there is nothing to compile it with.
    """
    folder = new_folder(stack)
    for name, text in beside.items():
        (folder / name).write_bytes(text)
    for file in (source, Path(__file__).with_name("export.h")):
        shutil.copy(file, folder)
    library = source.with_suffix(host_platform().suffix).name
    sources = sorted(path.name for path in folder.glob("*.c"))
    compile_library(folder, sources, library, c_compiler(), headers)
    return ctypes.CDLL(str(folder / library))
