"""Where a robot was to be: at the goal, or on its path."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.numbers import robot_pose
from laglab.results.summary import Following
from laglab.scenario import Scenario
from laglab_control import Path
from laglab_gateway import Trace

Array = NDArray[np.float64]


class Target(NamedTuple):
    """Of one scenario."""

    goal: tuple[float, float, float]
    path: Path | None
    sample_time: float

    def poses(self, ticks: Array) -> Array:
        """Where it was to be at each tick (n,), shape (n, 3) [m, m, rad]."""
        if self.path is None:
            return np.tile(self.goal, (len(ticks), 1))
        return self.path.sampled(ticks * self.sample_time)[:, :3]

    def outline(self) -> Array:
        """All the places where it was to be, shape (k, 2) [m]."""
        return np.array([self.goal[:2]]) if self.path is None else self.path.outline()


def target(scenario: Scenario) -> Target:
    """Of a run of that scenario."""
    return Target(scenario.goal, scenario.path, scenario.sample_time)


def followed(pieces: Iterable[Trace], of: Target, rows: int) -> Following | None:
    """How well, over the second half of a trace of so many rows; None where there was no path."""
    if of.path is None:
        return None
    first, count, squares, largest = rows // 2, 0, 0.0, 0.0
    for piece in pieces:
        distance = _distance(piece, of)[max(first, 0) :]
        first -= len(piece["tick"])
        distance = distance[~np.isnan(distance)]
        count += len(distance)
        squares += float(distance @ distance)
        largest = max(largest, float(distance.max(initial=0.0)))
    return Following(float(np.sqrt(squares / count)), largest) if count else None


def _distance(piece: Trace, of: Target) -> Array:
    off = robot_pose(piece) - of.poses(piece["tick"])
    distance: Array = np.hypot(off[:, 0], off[:, 1])
    return distance
