"""Where a loop that does not predict would stop settling, over the plane of a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.scenario import Scenario, changed
from laglab_control import PolarLaw, delay_margin

Array = NDArray[np.float64]
DELAYS = ("link.command_delay", "link.measurement_delay")
GAINS = ("law.lambda", "law.gamma", "law.h", "sample_time")
FINE = 61
"""Points along each side at which it is computed."""


class Excess(NamedTuple):
    """By how many ticks n + m is beyond each margin and half a tick: below 0 it settles."""

    approach: Array
    hold: Array
    """NaN without a goal tolerance."""


class Plane(NamedTuple):
    """The same over a map, shape (y, x)."""

    x: Array
    """Places in cells: the middle of the first one is 0."""
    y: Array
    excess: Excess


def moves_it(key: str) -> bool:
    """Whether a key has to do with the delay margin."""
    return key in DELAYS or key in GAINS


def excess(base: Scenario, x: str, xs: Array, y: str, ys: Array) -> Excess:
    """At the values of two keys, in all combinations; of a key that has nothing to do with it the
    values do not matter."""
    found = np.empty((2, len(ys), len(xs)))
    known: dict[tuple[float, ...], tuple[float, float]] = {}
    for i, j in np.ndindex(len(ys), len(xs)):
        point = {key: float(value) for key, value in ((x, xs[j]), (y, ys[i])) if moves_it(key)}
        gains = {key: value for key, value in point.items() if key in GAINS}
        margins = known.get(tuple(gains.values())) or _margins(base, gains)
        known[tuple(gains.values())] = margins
        found[:, i, j] = _ticks(base, point) - np.array(margins) - 0.5
    return Excess(*found)


def _ticks(base: Scenario, point: Mapping[str, float]) -> float:
    n, m = base.link.command_delay, base.link.measurement_delay
    return sum(point.get(key, own) for key, own in zip(DELAYS, (n, m), strict=True))


def _margins(base: Scenario, gains: Mapping[str, float]) -> tuple[float, float]:
    scenario = changed(base, gains)
    approach, hold = delay_margin(PolarLaw(**scenario.law.of(PolarLaw)), scenario.sample_time)
    return approach, np.nan if hold is None else hold


def plane(base: Scenario, x: str, xs: Sequence[object], y: str, ys: Sequence[object]) -> Plane:
    """Over a map with these values in its cells, in between them by interpolation."""
    along_x, along_y = (np.linspace(-0.5, len(of) - 0.5, FINE) for of in (xs, ys))
    at_x, at_y = _between(x, xs, along_x), _between(y, ys, along_y)
    return Plane(along_x, along_y, excess(base, x, at_x, y, at_y))


def _between(key: str, values: Sequence[object], places: Array) -> Array:
    if not moves_it(key):
        return np.zeros(len(places))
    known: Array = np.interp(places, np.arange(len(values)), np.array(values, dtype=float))
    return known
