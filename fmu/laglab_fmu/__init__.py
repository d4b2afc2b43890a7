"""Robots as Functional Mock-up Units: their build, and the steppers that drive them.

The differential drive is (1) and (3) of docs/theory.md with wheel and sensor noise; `Robot` steps
it by one sample, `Fleet` many of them at once; `foreign` steps any FMU, also the other robots that
ship. What needs FMPy is loaded when it is first used: who only talks to a robot does without.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from laglab_fmu.compiler import PLATFORMS, c_compiler, compile_library, host_platform
from laglab_fmu.errors import (
    BuildError,
    CallError,
    CompilerNotFoundError,
    FmuError,
    FmuFileError,
    FmuNotBuiltError,
    WiringError,
)
from laglab_fmu.others import OtherParameters
from laglab_fmu.parameters import INTEGRATIONS, Reading, RobotParameters, ShippedParameters
from laglab_fmu.unpacked import clear_unpacked

if TYPE_CHECKING:
    from laglab_fmu.archive.build import build_fmus
    from laglab_fmu.fleet import Fleet
    from laglab_fmu.robot import Robot
    from laglab_fmu.slave import VERSIONS, fleet_path, fmu_path
    from laglab_fmu.stepper import INPUTS, OUTPUTS

__all__ = [
    "INPUTS",
    "INTEGRATIONS",
    "OUTPUTS",
    "PLATFORMS",
    "VERSIONS",
    "BuildError",
    "CallError",
    "CompilerNotFoundError",
    "Fleet",
    "FmuError",
    "FmuFileError",
    "FmuNotBuiltError",
    "OtherParameters",
    "Reading",
    "Robot",
    "RobotParameters",
    "ShippedParameters",
    "WiringError",
    "build_fmus",
    "c_compiler",
    "clear_unpacked",
    "compile_library",
    "fleet_path",
    "fmu_path",
    "host_platform",
]

_NEED_FMPY = {
    "INPUTS": "stepper",
    "OUTPUTS": "stepper",
    "VERSIONS": "slave",
    "Fleet": "fleet",
    "Robot": "robot",
    "build_fmus": "archive.build",
    "fleet_path": "slave",
    "fmu_path": "slave",
}


def __getattr__(name: str) -> Any:
    if name not in _NEED_FMPY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_NEED_FMPY[name]}"), name)
