"""The one interface of all laws."""

from typing import NamedTuple, Protocol

import numpy as np

from laglab_control.model import Vector
from laglab_control.motion import Way


class Demand(NamedTuple):
    """What a law answers."""

    v: float
    """[m/s]."""
    omega: float
    """[rad/s]."""
    memory: object = None
    """What the law wants to be told at the next tick."""


STAND_STILL = Demand(0.0, 0.0)


class Law(Protocol):
    """A pure function from a pose to speeds."""

    def drive(self, pose: Way[float], time: float, memory: object) -> tuple[float, float, object]:
        """v [m/s], omega [rad/s] and a memory for the robot that will be at `pose` [m, m, rad].

        `time` [s] is when the command comes into force, from the robot's tick 0 on; it does not
        always grow by a tick, for the delay of commands is estimated. `memory` is that of the last
        answer, None at first. What limits speeds is applied afterwards (`SpeedLimits`).
        """
        ...


def as_input(drive: Demand) -> Vector:
    """u = [v, omega] (2,) [m/s, rad/s]."""
    return np.array((drive.v, drive.omega))


STAND = as_input(STAND_STILL)
"""The input before any command is in force."""
