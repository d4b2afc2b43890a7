"""What a guard would find in the innovations of many robots, which come at their own times.

It tells for which of them it would act; what it would do there is for the scalar code alone.
"""

from collections.abc import Iterable

import numpy as np

from laglab_control.batch.impaired.estimators import Weighed
from laglab_control.batch.impaired.past import Rows
from laglab_control.batch.impaired.timetable import Flags, Whole
from laglab_control.batch.matrices import Symmetric, plus_square
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
)
from laglab_control.motion import Way

KEPT = DRIFTS[-1] + 1
BOUNDS = np.array(
    [
        chi_square_bound(IMPROBABLE, DEGREES * count) if count >= FEWEST_OF_SPREAD else np.inf
        for count in range(SPREAD + 1)
    ]
)
"""What the NIS of so many innovations add up to at most."""


class Suspicion:
    """The evidence of all robots so far."""

    def __init__(self, robots: int) -> None:
        self.acts = np.zeros(robots, np.bool_)
        """The robots whose guard would have acted by now."""
        self._there = np.zeros(robots, np.int64)
        """How many innovations."""
        self._sums = np.zeros((KEPT, 4, robots))
        """Of NIS, x, y, theta up to each."""
        self._statistic = np.zeros(robots)
        self._mean = np.zeros((3, robots))

    def look(self, weighed: Iterable[Weighed]) -> None:
        """At all that has arrived at a tick."""
        for (robots, _, newer, settled), (v, weights) in weighed:
            nis = weighted(v, weights)
            self.acts[robots] |= settled & ~(nis <= WILD)
            proves = newer & settled
            if proves.all():
                self._weigh(robots, np.stack((nis, *v)), weights)
            elif proves.any():
                weights = Symmetric(*[each[proves] for each in weights])
                self._weigh(robots[proves], np.stack((nis, *v))[:, proves], weights)

    def claimed(self, P: Symmetric) -> Symmetric:
        """P, and b b^T where the innovations suggest an error b."""
        if not self._statistic.any():
            return P
        return plus_square(P, Way(*self._mean))

    def _weigh(self, robots: Whole, news: Rows, weights: Symmetric) -> None:
        there = self._there[robots] + 1
        newest = self._before(robots, there, 1) + news
        self._sums[there % KEPT, :, robots] = newest.T
        self._there[robots] = there
        looks = _length(there) % EVERY == 0
        if looks.any():
            of = robots[looks]
            weights = Symmetric(*[each[looks] for each in weights])
            self._statistic[of], self._mean[:, of] = self._lags(
                of, there[looks], newest[:, looks], weights
            )
        count = np.minimum(there, SPREAD)
        spread = newest[0] - self._before(robots, there, count)[0] > BOUNDS[count]
        self.acts[robots] |= spread | (self._statistic[robots] > LAGGING)

    def _before(self, robots: Whole, there: Whole, count: Whole | int) -> Rows:
        """The sums as they were `count` innovations ago."""
        sums: Rows = self._sums[(there - count) % KEPT, :, robots].T
        return sums

    def _lags(
        self, robots: Whole, there: Whole, newest: Rows, weights: Symmetric
    ) -> tuple[Row, Rows]:
        """The most telling of the windows' means; 0 where none is improbable."""
        statistic, mean = np.full(len(robots), SUSPECT), np.zeros((3, len(robots)))
        for count, full in self._windows(there):
            b = (newest - self._before(robots, there, count))[1:] / count
            each = count * weighted(_pose(b), weights)
            more = full & (each > statistic)
            statistic = np.where(more, each, statistic)
            mean = np.where(more, b, mean)
        return np.where(statistic > SUSPECT, statistic, 0.0), mean

    def _windows(self, there: Whole) -> Iterable[tuple[Whole, Flags]]:
        """As `laglab_control.guard.evidence.windows` has them, and which of the robots have it."""
        for count in DRIFTS:
            full = there >= count
            if full.any():
                yield np.full(len(there), count), full
        partly = (there > DRIFTS[0]) & (there < DRIFTS[-1]) & ~np.isin(there, DRIFTS)
        if partly.any():
            yield there, partly


def _pose(b: Rows) -> Pose:
    return Way(*b)


def _length(there: Whole) -> Whole:
    """Of a log of so many innovations, whose oldest are now and then let go (`append`)."""
    return np.where(there < 2 * KEPT, there + 1, KEPT + 1 + (there - 2 * KEPT) % KEPT)
