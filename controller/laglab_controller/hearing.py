"""What the robot's messages tell the controller; ticks are counted from the station's first."""

from collections.abc import Sequence

import numpy as np

from laglab_controller.estimator import Measured
from laglab_controller.flight import Echo
from laglab_protocol import Measurement


def measured(messages: Sequence[Measurement], first: int, tick: int) -> list[Measured]:
    """The poses measured from tick `first` to the present `tick`; no others make sense."""
    return [
        Measured(sampled - first, np.array((x, y, theta)))
        for x, y, theta, _, _, sampled, _ in messages
        if first <= sampled <= tick
    ]


def echoes(messages: Sequence[Measurement], first: int, tick: int) -> list[Echo]:
    """The commands that were in force just before each was sampled."""
    return [
        Echo(sampled - first - 1, np.array((v, omega)), made - first if made >= first else None)
        for _, _, _, v, omega, sampled, made in messages
        if first < sampled <= tick
    ]
