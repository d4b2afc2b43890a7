"""A trace of any length in a few numbers, read piece by piece."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.columns import joined
from laglab.results.numbers import (
    LAST_SECOND,
    RmsError,
    deviation,
    goal_errors,
    is_measured,
    last_second,
    loop_estimates,
    robot_pose,
)
from laglab.results.summary import Errors, Following, Seen
from laglab.scenario import Target
from laglab_gateway import Trace

Array = NDArray[np.float64]


class Digest(NamedTuple):
    """What the summary needs of a trace."""

    rows: int
    seen: Seen
    end: Trace
    """The last second."""
    rms_error: Errors | None


def digest(pieces: Iterable[Trace], measurement_delay: int) -> Digest:
    """Of the pieces of a trace, in order; there is one at least, and in each a row."""
    kept: list[Trace] = []
    rms = RmsError()
    rows = 0
    for piece in pieces:
        settled = max(measurement_delay - rows, 0)
        rms.add(deviation(piece, loop_estimates(piece))[settled:])
        rows += len(piece["tick"])
        kept = [each for each in kept if each["time"][-1] >= piece["time"][-1] - LAST_SECOND]
        kept.append(piece)
    end = _last_second(kept)
    return Digest(rows, "measured" if is_measured(end) else "true", end, rms.errors())


def _last_second(pieces: list[Trace]) -> Trace:
    whole = joined(pieces)
    last = last_second(whole["time"])
    return {name: column[last] for name, column in whole.items()}


def followed(pieces: Iterable[Trace], of: Target, rows: int) -> Following | None:
    """How well the path was followed, over the second half of a trace of `rows` rows; None without
    a path."""
    if of.path is None:
        return None
    first, count, squares, largest = rows // 2, 0, 0.0, 0.0
    for piece in pieces:
        distance = goal_errors(robot_pose(piece), of.poses(piece["tick"]))[0][max(first, 0) :]
        first -= len(piece["tick"])
        distance = distance[~np.isnan(distance)]
        count += len(distance)
        squares += float(distance @ distance)
        largest = max(largest, float(distance.max(initial=0.0)))
    return Following(float(np.sqrt(squares / count)), largest) if count else None
