"""How well a robot followed its path."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from laglab.results.numbers import robot_pose
from laglab.results.summary import Following
from laglab.scenario import Target
from laglab_gateway import Trace

Array = NDArray[np.float64]


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
