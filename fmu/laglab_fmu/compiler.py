"""Finding a C compiler, and compiling the FMU's shared library with it."""

import platform
import shlex
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import fmpy

from laglab_fmu.errors import BuildError, CompilerNotFoundError

FLAGS = (
    *("-std=c99", "-O2", "-ffp-contract=off", "-fvisibility=hidden"),
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


def zig_compiler(target: Platform) -> list[str]:
    """The command of ziglang's C compiler for a platform.

    Raises:
        CompilerNotFoundError: ziglang is not installed.
    """
    if find_spec("ziglang") is None:
        raise CompilerNotFoundError(
            f"no compiler to build the FMU for {target.system} on {target.machine} with: "
            "install a C compiler, or `pip install ziglang`"
        )
    return [sys.executable, "-m", "ziglang", "cc", "-target", target.zig_target]


def compile_library(
    folder: Path, sources: Sequence[str], library: str, compiler: Sequence[str]
) -> None:
    """Compiles C sources in a folder into one shared library there, which asks for libm itself.

    Works in that folder with relative names, so that its place does not show in the library.

    Raises:
        BuildError: the compiler failed; with what it said.
    """
    shared = ["-shared"] if library.endswith(".dll") else ["-shared", "-fPIC"]
    includes = ["-isystem", str(fmi_headers())]
    command = [*compiler, *FLAGS, *REPRODUCIBLE, *shared, *includes, "-o", library, *sources, "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode:
        said = done.stderr.strip()
        raise BuildError(f"compiling {library} failed: {shlex.join(command)}\n{said}")


def fmi_headers() -> Path:
    """The folder of the FMI 2.0 and 3.0 headers, which the installed fmpy carries."""
    return Path(fmpy.__file__).parent / "c-code"
