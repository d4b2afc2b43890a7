"""One robot, stepped a sample at a time."""

import ctypes
import struct
from functools import partial
from typing import Self

from laglab_fmu.parameters import Reading, RobotParameters
from laglab_fmu.slave import Slave2, Slave3, fmu_path
from laglab_fmu.stepper import INPUTS, OUTPUTS, Stepper

_unpack = struct.Struct(f"{len(OUTPUTS)}d").unpack
_reading = partial(tuple.__new__, Reading)  # what Reading._make does, without its Python frame


class Robot(Stepper):
    """The FMU in co-simulation: `with Robot.open(3, parameters) as robot:`."""

    @classmethod
    def open(cls, version: int, parameters: RobotParameters) -> Self:
        """A robot at its start pose, tick 0 sampled.

        Args:
            version: 2 or 3, of FMI; both give the same bits.

        Raises:
            ValueError: no such version, integration or seed.
            FmuNotBuiltError: the FMU is not there.
            CallError: it does not start, or refuses a parameter.
        """
        return cls(version, parameters)

    def __init__(self, version: int, parameters: RobotParameters) -> None:
        super().__init__(fmu_path(version), Slave2 if version == 2 else Slave3, [parameters])
        self._speeds = (ctypes.c_double * len(INPUTS))()
        self._doubles = (ctypes.c_double * len(OUTPUTS))()
        self.inputs.value = ctypes.addressof(self._speeds)
        self.outputs.value = ctypes.addressof(self._doubles)

    def read(self) -> Reading:
        """Pose, last measurement and body speeds now, without moving.

        Raises:
            CallError: the FMU refused.
        """
        self.fetch()
        return _reading(_unpack(self._doubles))

    def step(self, omega_left: float, omega_right: float) -> Reading:
        """Moves for one sample time with these wheel speeds, in rad/s, and reads.

        Raises:
            CallError: the FMU refused, for instance a speed that is not finite; nothing moved.
        """
        self._speeds[0] = omega_left
        self._speeds[1] = omega_right
        self.advance()
        return _reading(_unpack(self._doubles))

    def reset(self, parameters: RobotParameters) -> None:
        """Starts again, with other parameters, without loading anything anew.

        Raises:
            ValueError: no such integration or seed.
            CallError: the FMU refuses a parameter; reset again with better ones.
        """
        self.restart([parameters])
