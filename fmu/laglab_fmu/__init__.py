"""The robot as a Functional Mock-up Unit: its build, and the stepper that drives it.

The plant is equations (1) and (3) of the paper with wheel and sensor noise; `Robot` steps it by
one sample, `Fleet` many of them at once.
"""

from laglab_fmu.build import build_fmus
from laglab_fmu.compiler import PLATFORMS
from laglab_fmu.errors import (
    BuildError,
    CallError,
    CompilerNotFoundError,
    FmuError,
    FmuNotBuiltError,
)
from laglab_fmu.fleet import Fleet
from laglab_fmu.parameters import Reading, RobotParameters
from laglab_fmu.robot import Robot
from laglab_fmu.slave import fleet_path, fmu_path

__all__ = [
    "PLATFORMS",
    "BuildError",
    "CallError",
    "CompilerNotFoundError",
    "Fleet",
    "FmuError",
    "FmuNotBuiltError",
    "Reading",
    "Robot",
    "RobotParameters",
    "build_fmus",
    "fleet_path",
    "fmu_path",
]
