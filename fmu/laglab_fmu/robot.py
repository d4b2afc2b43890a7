"""One robot, stepped a sample at a time."""

import ctypes
from contextlib import ExitStack
from types import TracebackType
from typing import Self

from laglab_fmu.errors import CallError
from laglab_fmu.parameters import Reading, RobotParameters
from laglab_fmu.slave import DISCARD, initialize, open_slave

INPUTS = ("omega_left", "omega_right")


class Robot:
    """The FMU in co-simulation: `with Robot.open(3, parameters) as robot:`."""

    @classmethod
    def open(cls, version: int, parameters: RobotParameters) -> Self:
        """A robot at its start pose, tick 0 sampled.

        Args:
            version: 2 or 3, of FMI; both give the same bits.

        Raises:
            ValueError: no such version or integration.
            FmuNotBuiltError: the FMU is not there.
            CallError: it does not start, or refuses a parameter.
        """
        return cls(version, parameters)

    def __init__(self, version: int, parameters: RobotParameters) -> None:
        with ExitStack() as stack:
            self._slave = open_slave(version, stack)
            initialize(self._slave, parameters)
            self._stack = stack.pop_all()
        self._inputs = (ctypes.c_double * len(INPUTS))()
        self._outputs = (ctypes.c_double * len(Reading._fields))()
        self._time, self._sample_time = ctypes.c_double(), ctypes.c_double()
        self._set = self._slave.setter(INPUTS, self._inputs)
        self._do_step = self._slave.stepper(self._time, self._sample_time)
        self._get = self._slave.getter(Reading._fields, self._outputs)
        self._start(parameters)

    def _start(self, parameters: RobotParameters) -> None:
        self._tick = 0
        self._sample_time.value = parameters.sample_time

    def read(self) -> Reading:
        """Pose, last measurement and body speeds now, without moving.

        Raises:
            CallError: the FMU refused.
        """
        if self._get() >= DISCARD:
            raise self._refused()
        return Reading._make(self._outputs)

    def step(self, omega_left: float, omega_right: float) -> Reading:
        """Moves for one sample time with these wheel speeds, in rad/s, and reads.

        Raises:
            CallError: the FMU refused, for instance a speed that is not finite; nothing moved.
        """
        self._inputs[0] = omega_left
        self._inputs[1] = omega_right
        self._time.value = self._tick * self._sample_time.value
        if self._set() >= DISCARD or self._do_step() >= DISCARD or self._get() >= DISCARD:
            raise self._refused()
        self._tick += 1
        return Reading._make(self._outputs)

    def _refused(self) -> CallError:
        message = "; ".join(self._slave.log)
        self._slave.log.clear()
        return CallError(f"tick {self._tick}: {message}")

    def reset(self, parameters: RobotParameters) -> None:
        """Starts again, with other parameters, without loading anything anew.

        Raises:
            CallError: the FMU refuses a parameter; reset again with better ones.
        """
        self._slave.reset()
        initialize(self._slave, parameters)
        self._start(parameters)

    def close(self) -> None:
        """Frees the instance and the library, removes the extracted files. Twice does no harm."""
        self._stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
