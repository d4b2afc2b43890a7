"""The C compiler of this machine, or ziglang's, and compiling a shared library with it.

Needs nothing that is not in Python itself: the build hook asks before anything is installed.
"""

import os
import platform
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from laglab_fmu.errors import BuildError, CompilerNotFoundError

FLAGS = (
    *("-std=c99", "-O3", "-ffp-contract=off", "-fvisibility=hidden"),
    *("-Wall", "-Wextra", "-Wpedantic", "-Werror"),
)
REPRODUCIBLE = ("-g0", "-s")
"""No debug information: it would hold the folder's name."""


@dataclass(frozen=True)
class Platform:
    """Where a binary runs; folder names are FMI's."""

    system: str
    machine: str
    suffix: str
    fmi2_folder: str
    zig_target: str

    @property
    def fmi3_folder(self) -> str:
        return f"{self.machine}-{self.system}"


PLATFORMS = (
    Platform("linux", "x86_64", ".so", "linux64", "x86_64-linux-gnu.2.17"),
    Platform("linux", "aarch64", ".so", "aarch64-linux", "aarch64-linux-gnu.2.17"),
    Platform("windows", "x86_64", ".dll", "win64", "x86_64-windows-gnu"),
    Platform("windows", "aarch64", ".dll", "aarch64-windows", "aarch64-windows-gnu"),
    Platform("darwin", "x86_64", ".dylib", "darwin64", "x86_64-macos.11.0"),
    Platform("darwin", "aarch64", ".dylib", "aarch64-darwin", "aarch64-macos.11.0"),
)


def host_platform() -> Platform:
    """The platform this Python runs on.

    Raises:
        BuildError: it is none of PLATFORMS.
    """
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(
        platform.machine().lower(), platform.machine()
    )
    for candidate in PLATFORMS:
        if (candidate.system, candidate.machine) == (platform.system().lower(), machine):
            return candidate
    raise BuildError(
        f"no FMU binary is known for {platform.system()} on {platform.machine()}; "
        "add it to laglab_fmu.compiler.PLATFORMS"
    )


def c_compiler() -> list[str]:
    """The command of the C compiler that compiles for this machine: $CC first, ziglang last.

    Raises:
        CompilerNotFoundError: there is none, not even ziglang.
        BuildError: there is none but ziglang, and this platform is none of PLATFORMS.
    """
    return host_compiler() or zig_compiler(host_platform())


def host_compiler() -> list[str] | None:
    """The command of the host's own: $CC, else cc, gcc or clang on the PATH; None without.

    Raises CompilerNotFoundError: $CC is no command here.
    """
    if chosen := os.environ.get("CC", "").strip():
        return _command(chosen)
    return next(([name] for name in ("cc", "gcc", "clang") if shutil.which(name)), None)


def _command(chosen: str) -> list[str]:
    try:
        words = shlex.split(chosen)
    except ValueError:
        words = []
    if not (words and shutil.which(words[0])):
        raise CompilerNotFoundError(f"CC={chosen!r} is no command here: correct or unset it")
    return words


def zig_compiler(target: Platform) -> list[str]:
    """The command of ziglang's C compiler for a platform.

    Raises:
        CompilerNotFoundError: ziglang is not installed.
    """
    if find_spec("ziglang") is None:
        raise CompilerNotFoundError(
            f"no C compiler for {target.system} on {target.machine}: install one, "
            "or `pip install ziglang`"
        )
    return [sys.executable, "-m", "ziglang", "cc", "-target", target.zig_target]


def compile_library(
    folder: Path,
    sources: Sequence[str],
    library: str,
    compiler: Sequence[str],
    headers: Path | None = None,
) -> None:
    """Compiles C sources in a folder into one shared library there, which loads libm by itself.

    Works in that folder with relative names, so that its place does not show in the library.
    `headers` is a folder of other people's headers, whose warnings are theirs.

    Raises:
        BuildError: the compiler failed; with what it said.
    """
    shared = ["-shared"] if library.endswith(".dll") else ["-shared", "-fPIC"]
    include = ["-isystem", str(headers)] if headers else []
    command = [*compiler, *FLAGS, *REPRODUCIBLE, *shared, *include, "-o", library, *sources, "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode:
        said = done.stderr.strip()
        raise BuildError(f"compiling {library} failed: {shlex.join(command)}\n{said}")
