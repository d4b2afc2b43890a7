"""What the robot's messages tell the controller; ticks are counted from the station's first."""

from collections.abc import Sequence

import numpy as np

from laglab_controller.estimator import Measured
from laglab_controller.flight import Echo
from laglab_protocol import Measurement


def measured(messages: Sequence[Measurement], first: int, tick: int) -> list[Measured]:
    """The poses measured from tick `first` to the present `tick`; no others make sense."""
    return [
        Measured(message.tick - first, np.array(message[:3]))
        for message in messages
        if first <= message.tick <= tick
    ]


def echoes(messages: Sequence[Measurement], first: int, tick: int) -> list[Echo]:
    """The commands that were in force just before each was sampled."""
    return [
        Echo(
            message.tick - first - 1,
            np.array((message.v, message.omega)),
            message.command_tick - first if message.command_tick >= first else None,
        )
        for message in messages
        if first < message.tick <= tick
    ]
