"""Where a robot is to be: at the goal, or on its path."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control import Path

Array = NDArray[np.float64]


class Target(NamedTuple):
    """Of one scenario."""

    goal: tuple[float, float, float]
    path: Path | None
    sample_time: float

    def poses(self, ticks: Array) -> Array:
        """Where it is to be at each tick (n,), shape (n, 3) [m, m, rad]."""
        if self.path is None:
            return np.tile(self.goal, (len(ticks), 1))
        return self.path.sampled(ticks * self.sample_time)[:, :3]

    def outline(self) -> Array:
        """All the places where it is to be, shape (k, 2) [m]."""
        return np.array([self.goal[:2]]) if self.path is None else self.path.outline()
