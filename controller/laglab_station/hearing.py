"""What the robot's messages tell the controller; ticks are counted from the station's first."""

from collections.abc import Sequence

import numpy as np

from laglab_control.estimators.interface import Measured
from laglab_control.flight import Echo
from laglab_protocol import Measurement


def measured(messages: Sequence[Measurement], first: int, tick: int) -> list[Measured]:
    """The poses measured from tick `first` to the present `tick`; no others make sense."""
    return [
        Measured(message.tick - first, np.array(message.pose))
        for message in messages
        if first <= message.tick <= tick
    ]


def echoes(messages: Sequence[Measurement], first: int, tick: int) -> list[Echo]:
    """The commands that were in force just before each was sampled."""
    return [_echo(message, first) for message in messages if first < message.tick <= tick]


def _echo(message: Measurement, first: int) -> Echo:
    made = message.command_tick - first
    speeds = np.array(message.speeds)
    return Echo(message.tick - first - 1, speeds, made if made >= 0 else None)
