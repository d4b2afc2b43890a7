"""What a guard would find in the innovations of many robots (`laglab_control.guard.evidence`).

It tells for which of them it would act; what it would do there is for the scalar code alone.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch.matrices import Symmetric, plus_square
from laglab_control.batch.robots import Compared
from laglab_control.batch.rows import Pose, Row
from laglab_control.chi_square import chi_square_bound
from laglab_control.estimators.kalman import weighted
from laglab_control.guard.evidence import (
    DEGREES,
    DRIFTS,
    EVERY,
    FEWEST_OF_SPREAD,
    IMPROBABLE,
    LAGGING,
    SPREAD,
    SUSPECT,
    WILD,
    windows,
)
from laglab_control.motion import Way
from laglab_control.past.log import Log, append, logged


class Sums(NamedTuple):
    """Over all innovations so far."""

    nis: Row
    x: Row
    y: Row
    theta: Row


class Lags(NamedTuple):
    """The most telling of the windows' means, of each robot."""

    statistic: Row
    """0 where none is improbable."""
    mean: Pose


class Found(NamedTuple):
    """The evidence so far; immutable."""

    evidence: Log[Sums]
    lags: Lags
    acts: NDArray[np.bool_]
    """The robots whose guard would have acted by now."""


def nothing_found(robots: int) -> Found:
    """Before the first innovation."""
    zeros = np.zeros(robots)
    lags = Lags(zeros, Way(zeros, zeros, zeros))
    return Found(logged(Sums(*[zeros] * 4)), lags, np.zeros(robots, np.bool_))


def looked_at(found: Found, compared: Compared) -> Found:
    """With one more innovation of each robot."""
    v, weights = compared
    nis = weighted(v, weights)
    last = found.evidence.newest
    sums = Sums(last.nis + nis, last.x + v.x, last.y + v.y, last.theta + v.theta)
    evidence = append(found.evidence, sums, DRIFTS[-1] + 1)
    lags = found.lags if evidence.length % EVERY else _lags(evidence, weights)
    acts = found.acts | ~(nis <= WILD) | (lags.statistic > LAGGING) | _spread(evidence)
    return Found(evidence, lags, acts)


def claimed(P: Symmetric, found: Found) -> Symmetric:
    """P, and b b^T where the innovations suggest an error b."""
    if not found.lags.statistic.any():
        return P
    return plus_square(P, found.lags.mean)


def _lags(evidence: Log[Sums], weights: Symmetric) -> Lags:
    items, length = evidence
    newest = items[length - 1]
    statistic = np.full(len(newest.x), SUSPECT)
    mean = Way(*[np.zeros(len(newest.x))] * 3)
    for count in windows(length - 1):
        b = _mean(items[length - 1 - count], newest, count)
        each = count * weighted(b, weights)
        more = each > statistic
        if more.any():
            statistic = np.where(more, each, statistic)
            mean = Way(*[np.where(more, *pair) for pair in zip(b, mean, strict=True)])
    return Lags(np.where(statistic > SUSPECT, statistic, 0.0), mean)


def _mean(oldest: Sums, newest: Sums, count: int) -> Pose:
    return Way(
        (newest.x - oldest.x) / count,
        (newest.y - oldest.y) / count,
        (newest.theta - oldest.theta) / count,
    )


def _spread(evidence: Log[Sums]) -> NDArray[np.bool_]:
    items, length = evidence
    count = min(length - 1, SPREAD)
    if count < FEWEST_OF_SPREAD:
        return np.zeros(len(items[0].nis), np.bool_)
    bound = chi_square_bound(IMPROBABLE, DEGREES * count)
    return items[length - 1].nis - items[length - 1 - count].nis > bound
