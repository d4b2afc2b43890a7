"""Finding a C compiler, and compiling the FMU's shared library with it."""

import platform
import shlex
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from laglab_fmu.errors import BuildError, CompilerNotFoundError

FLAGS = (
    "-std=c99",
    "-O2",
    "-ffp-contract=off",
    "-fvisibility=hidden",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Werror",
)


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
    sources: Sequence[Path], includes: Sequence[Path], library: Path, compiler: Sequence[str]
) -> None:
    """Compiles C sources into one shared library that carries its own need of libm.

    Raises:
        BuildError: the compiler failed; with what it said.
    """
    command = [*compiler, *FLAGS, *_shared(library), "-o", str(library)]
    command += [argument for folder in includes for argument in ("-isystem", str(folder))]
    command += [*map(str, sources), "-lm"]
    library.parent.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise BuildError(
            f"compiling {library.name} failed: {shlex.join(command)}\n{done.stderr.strip()}"
        )


def _shared(library: Path) -> list[str]:
    if library.suffix == ".dll":
        return ["-shared"]
    return ["-shared", "-fPIC"]
