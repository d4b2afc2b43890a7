"""Builds the FMUs when the package is installed, in editable and in ordinary wheels.

Whoever installs from sources gets this machine's binaries, in seconds, from its own compiler. With
LAGLAB_ALL_PLATFORMS=1 the wheel holds those of every platform and is tagged for any: the one to
release (docs/releasing.md). One built without it by mistake is tagged linux_x86_64 or the like,
which package indexes refuse.
"""

import os
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

from laglab_fmu.compiler import PLATFORMS, host_compiler  # noqa: E402 needs nothing installed

FMPY, ZIGLANG = "fmpy>=0.3.30", "ziglang>=0.13"
RELEASED_WITH = "ziglang==0.17.1"
"""One compiler for all who build a release: another one gives other bytes."""


class FmuBuildHook(BuildHookInterface[Any]):
    """Hatchling's hook: a wheel with FMUs holds native code, but depends on no Python ABI."""

    def dependencies(self) -> list[str]:
        """fmpy brings the FMI headers; ziglang compiles for others, or where nothing else does."""
        if self.target_name != "wheel":
            return []
        if _for_all_platforms():
            return [FMPY, RELEASED_WITH]
        return [FMPY] if host_compiler() else [FMPY, ZIGLANG]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Builds into the package folder: hatchling and an editable installation find it there."""
        if self.target_name != "wheel":
            return
        from laglab_fmu.archive.build import build_fmus  # needs what `dependencies` asks for

        build_fmus(HERE / "laglab_fmu", PLATFORMS if _for_all_platforms() else ())
        build_data["pure_python"] = _for_all_platforms()
        build_data["tag"] = f"py3-none-{_platform_tag()}"
        if version == "standard":
            for folder in ("src", "content"):
                build_data["force_include"][str(HERE / folder)] = f"laglab_fmu/{folder}"


def _for_all_platforms() -> bool:
    return os.environ.get("LAGLAB_ALL_PLATFORMS") == "1"


def _platform_tag() -> str:
    if _for_all_platforms():
        return "any"
    return sysconfig.get_platform().replace("-", "_").replace(".", "_")
