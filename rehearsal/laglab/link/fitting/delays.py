"""Delays: the simplest distribution that scatters as they do, and how one follows the other."""

import math
from statistics import NormalDist

import numpy as np

from laglab.link.fitting.goodness import DIGITS, distance
from laglab.link.measured import Array
from laglab_gateway import ExtraDelay

CLOSE = 0.02
"""How far a distribution of two numbers may be from what was measured (Kolmogorov-Smirnov
distance); beyond that it is a table."""
STEPS = (10, 20, 50, 100, 200)
"""Steps of a table's probability: the fewest are taken that do for its distance and its tail."""
TAIL, TAIL_CLOSE = 0.99, 0.03
DRAWN = 4000
"""Quantiles that stand for a distribution."""
LEAST_SCATTER = 2e-5
"""[s] What scatters less is constant: clocks and programs do."""
LEAST_CORRELATION = 0.05
MOST_CORRELATION = 0.999


def fit_delays(extra: Array) -> ExtraDelay | None:
    """Of delays on top of the fixed one [s], in the order of sending, NaN where a frame was lost.

    None where there is nothing on top.
    """
    came = extra[~np.isnan(extra)]
    if not len(came):
        return None
    if float(np.ptp(came)) < LEAST_SCATTER:
        mean = _rounded(float(came.mean()))
        return ExtraDelay("constant", mean) if mean > LEAST_SCATTER else None
    correlation = _rounded(wandering(extra))
    named = min(_named(came, correlation), key=lambda each: distance_to(came, each))
    return named if distance_to(came, named) < CLOSE else _table(came, correlation)


def _named(came: Array, correlation: float) -> list[ExtraDelay]:
    mean, deviation = _rounded(float(came.mean())), _rounded(float(came.std()))
    half_width = _rounded(math.sqrt(3) * float(came.std()))
    return [
        ExtraDelay("uniform", mean, half_width, correlation=correlation),
        ExtraDelay("normal", mean, deviation, correlation=correlation),
        ExtraDelay("exponential", mean, correlation=correlation),
    ]


def _table(came: Array, correlation: float) -> ExtraDelay:
    for steps in STEPS:
        quantiles = np.quantile(came, np.linspace(0.0, 1.0, steps + 1))
        rounded = tuple(_rounded(float(each)) for each in quantiles)
        table = ExtraDelay("table", quantiles=rounded, correlation=correlation)
        tail = float(np.quantile(came, TAIL))
        if distance_to(came, table) < CLOSE / 2 and abs(table.at(TAIL) / tail - 1) < TAIL_CLOSE:
            break
    return table


def distance_to(came: Array, fitted: ExtraDelay) -> float:
    """The largest difference of the shares that stay within a delay, measured and fitted."""
    drawn = np.array([fitted.at((i + 0.5) / DRAWN) for i in range(DRAWN)])
    return distance(came, drawn)


def wandering(delay: Array) -> float:
    """The correlation of the normal scores of one frame's delay and the next one's, where both
    came: 0 where they jump."""
    came = ~np.isnan(delay)
    scores = np.full(len(delay), np.nan)
    scores[came] = _normal_scores(delay[came])
    both = came[1:] & came[:-1]
    earlier, later = scores[:-1][both], scores[1:][both]
    if len(earlier) < 3 or not (earlier.std() and later.std()):
        return 0.0
    found = float(np.corrcoef(earlier, later)[0, 1])
    return min(found, MOST_CORRELATION) if found > LEAST_CORRELATION else 0.0


def _normal_scores(values: Array) -> Array:
    """Where each would stand if they were normal; equal ones stand together."""
    _, places, counts = np.unique(values, return_inverse=True, return_counts=True)
    ranks = np.cumsum(counts) - 0.5 * (counts + 1)
    normal = NormalDist()
    scores = np.array([normal.inv_cdf(float((rank + 0.5) / len(values))) for rank in ranks])
    return np.asarray(scores[places])


def _rounded(seconds: float) -> float:
    return max(round(seconds, DIGITS), 0.0)
