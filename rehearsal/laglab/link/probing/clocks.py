"""Two clocks, and what they tell of how long a frame took.

A frame is stamped by the sender's clock and by the receiver's; what lies between is its delay and
how far the second clock is ahead. Where the clocks are not known to agree, that is taken from the
fastest frames: beneath the differences of each direction lies a straight line, for clocks drift
(S. B. Moon, P. Skelly, D. Towsley, "Estimation and removal of clock skew from network delay
measurements", INFOCOM 1999). The two lines' sum is the shortest round trip, which needs no common
clock; that half of it belongs to each direction is assumed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


MOST_DRIFT = 2e-4
"""The most that two clocks drift apart [s/s]: a steeper line is no drift, but too few frames."""
TINY = 1e-9
"""[s]"""


class ClockTimes(NamedTuple):
    """Of each frame of one direction."""

    sent: Array
    """[s] Since the first, by the sender's clock."""
    apart: Array
    """[s] The receiver's clock at arrival less the sender's at sending; NaN: it never came."""

    @classmethod
    def of(cls, sent_ns: Sequence[int], came_ns: Sequence[int | None]) -> ClockTimes:
        """Differences are taken as integers: a double does not hold today in nanoseconds."""
        apart = [
            math.nan if came is None else (came - sent) * 1e-9
            for sent, came in zip(sent_ns, came_ns, strict=True)
        ]
        first = sent_ns[0] if sent_ns else 0
        return cls(np.array([(sent - first) * 1e-9 for sent in sent_ns]), np.array(apart))


class Clocks(NamedTuple):
    """The delays by the two clocks, and what is to be said of them."""

    ours: Array
    """[s] Of the frames from here; NaN: it never came."""
    theirs: Array
    """[s] Of the frames from there."""
    note: str


def seen_by_clocks(ours: ClockTimes, theirs: ClockTimes, within: float | None) -> Clocks:
    """The delays each way; the clocks agree within `within` [s], None where that is not known."""
    if within is not None:
        told = [times.apart[~np.isnan(times.apart)] for times in (ours, theirs)]
        least = min(float(each.min()) for each in told if len(each)) if any(map(len, told)) else 0.0
        if least >= -within:
            note = (
                f"one-way delays, by two clocks that are said to agree within {1e3 * within:g} ms"
            )
            return Clocks(np.maximum(ours.apart, 0), np.maximum(theirs.apart, 0), note)
        found = (
            f"The clocks do not agree within {1e3 * within:g} ms: a frame came "
            f"{-1e3 * least:.3g} ms before it was sent. "
        )
    else:
        found = ""
    return _by_round_trips(ours, theirs, found)


def _by_round_trips(ours: ClockTimes, theirs: ClockTimes, found: str) -> Clocks:
    there, back = lowest_line(ours), lowest_line(theirs)
    if there is None or back is None:
        return Clocks(
            np.full_like(ours.apart, np.nan),
            np.full_like(theirs.apart, np.nan),
            found + "nothing came from one end, so no delay is known",
        )
    ahead = 0.5 * (there.at(ours.sent) - back.at(ours.sent))
    behind = 0.5 * (there.at(theirs.sent) - back.at(theirs.sent))
    middle = float(np.median(ours.sent))
    shortest = float(there.at(middle) + back.at(middle))
    note = (
        f"{found}The clocks are not known to agree: half of the shortest round trip, "
        f"{1e3 * shortest:.3g} ms, is taken for the fastest frame each way; what a frame took "
        "longer than that is one-way."
    )
    return Clocks(np.maximum(ours.apart - ahead, 0), np.maximum(theirs.apart + behind, 0), note)


class LowestLine(NamedTuple):
    """A straight line over time."""

    time: float
    value: float
    slope: float

    def at(self, time: Array | float) -> Array:
        """Its value."""
        return np.asarray(self.value + self.slope * (np.asarray(time) - self.time))


def lowest_line(times: ClockTimes) -> LowestLine | None:
    """The line beneath all points that is nearest to them on average: the edge of their lower
    convex hull that spans their mean time; level where that would be steeper than clocks drift.
    None without points."""
    came = ~np.isnan(times.apart)
    if not came.any():
        return None
    points = np.column_stack([times.sent[came], times.apart[came]])
    points = points[np.lexsort((points[:, 1], points[:, 0]))]
    hull = _lower_hull(points.tolist())
    middle = float(points[:, 0].mean())
    for (t0, d0), (t1, d1) in pairwise(hull):
        if t0 <= middle <= t1 and abs(d1 - d0) <= MOST_DRIFT * (t1 - t0):
            return LowestLine(t0, d0, (d1 - d0) / max(t1 - t0, TINY))
    return LowestLine(hull[0][0], min(d for _, d in hull), 0.0)


def _lower_hull(points: list[list[float]]) -> list[list[float]]:
    """Of points ordered by time: Andrew's monotone chain."""
    hull: list[list[float]] = []
    for t, d in points:
        while len(hull) > 1 and _is_above(hull[-2], hull[-1], t, d):
            hull.pop()
        hull.append([t, d])
    return hull


def _is_above(first: list[float], second: list[float], t: float, d: float) -> bool:
    """Whether the second point lies above, or on, the line from the first to (t, d)."""
    return (second[0] - first[0]) * (d - first[1]) <= (second[1] - first[1]) * (t - first[0])
