"""What stepping one robot and stepping a fleet have in common."""

import ctypes
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from laglab_fmu.errors import CallError
from laglab_fmu.models import ROBOT
from laglab_fmu.parameters import Reading, ShippedParameters
from laglab_fmu.slave import Slave, initialize, open_slave

INPUTS = ROBOT.inputs
OUTPUTS = Reading._fields


class Stepper:
    """An open FMU instance of some robots, moved by their common sample time at each call.

    Values go through two arrays at `inputs` and `outputs`: all robots' values of one variable, then
    of the next.
    """

    def __init__(
        self,
        path: Path,
        make: Callable[[str], Slave],
        robots: Sequence[ShippedParameters],
        inputs: Sequence[str] = INPUTS,
    ) -> None:
        sample_time = common_sample_time(robots)
        with ExitStack() as stack:
            self._slave = open_slave(path, make, stack)
            initialize(self._slave, robots)
            self._stack = stack.pop_all()
        self.inputs, self.outputs = ctypes.c_void_p(), ctypes.c_void_p()
        self._tick = 0
        self._sample_time = sample_time
        self._time, self._step_size = ctypes.c_double(), ctypes.c_double(sample_time)
        self._set = self._slave.setter(inputs, self.inputs, len(inputs) * len(robots))
        self._step = self._slave.stepper(self._time, self._step_size)
        self._get = self._slave.getter(OUTPUTS, self.outputs, len(OUTPUTS) * len(robots))

    def fetch(self) -> None:
        """Fills the output array.

        Raises:
            CallError: the FMU refused.
        """
        if self._get():
            raise self._refused()

    def advance(self) -> None:
        """Takes the input array, moves by one sample time, fills the output array.

        Raises:
            CallError: the FMU refused; nothing moved.
        """
        self._time.value = self._tick * self._sample_time
        if self._set() or self._step() or self._get():
            raise self._refused()
        self._tick += 1

    def _refused(self) -> CallError:
        message = "; ".join(self._slave.log)
        self._slave.log.clear()
        return CallError(f"tick {self._tick}: {message}")

    def restart(self, robots: Sequence[ShippedParameters]) -> None:
        """Starts again with other parameters, without loading anything anew.

        Raises:
            ValueError: the sample times differ; no such integration or seed.
            CallError: the FMU refuses a parameter; restart with better ones.
        """
        self._tick, self._sample_time = 0, common_sample_time(robots)
        self._step_size.value = self._sample_time
        self._slave.reset()
        initialize(self._slave, robots)

    def close(self) -> None:
        """Frees the instance and the library, removes the extracted files. Twice does no harm."""
        self._set = self._step = self._get = _closed
        self._stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _closed() -> int:
    """Takes the place of the FMU's functions, which would read freed memory."""
    raise CallError("the FMU instance has been closed; open another")


def common_sample_time(robots: Sequence[ShippedParameters]) -> float:
    """The sample time of all the robots.

    Raises:
        ValueError: there is no robot, or they differ.
    """
    times = {robot.sample_time for robot in robots}
    if len(times) != 1:
        raise ValueError(f"{len(robots)} robots have {len(times)} sample times, not one")
    return times.pop()
