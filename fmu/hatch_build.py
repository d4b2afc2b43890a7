"""Builds the FMUs when the package is installed, in editable and in ordinary wheels."""

import runpy
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).parent


class FmuBuildHook(BuildHookInterface[Any]):
    """Hatchling's hook: a wheel with FMUs holds native code, but depends on no Python ABI."""

    def dependencies(self) -> list[str]:
        """fmpy brings the FMI headers; ziglang compiles where nothing else does."""
        if self.target_name != "wheel":
            return []
        # The package itself cannot be imported yet: what it needs is what is being asked for.
        host = runpy.run_path(str(HERE / "laglab_fmu" / "host.py"))
        return ["fmpy>=0.3.22"] if host["host_compiler"]() else ["fmpy>=0.3.22", "ziglang>=0.13"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Builds into the package folder: hatchling and an editable installation find it there."""
        if self.target_name != "wheel":
            return
        sys.path.insert(0, str(HERE))
        from laglab_fmu.build import build_fmus

        build_fmus(HERE / "laglab_fmu")
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{platform}"
        if version == "standard":
            for folder in ("src", "content"):
                build_data["force_include"][str(HERE / folder)] = f"laglab_fmu/{folder}"
