"""`popf` and `popf-printed` for many robots whose measurements come when they do."""

from collections.abc import Sequence

import numpy as np

from laglab_control.angle import wrapped
from laglab_control.batch.impaired.estimators import Estimator, Weighed
from laglab_control.batch.impaired.factors import Factors
from laglab_control.batch.impaired.past import Past, PastMatrices, Rows, Stack
from laglab_control.batch.impaired.record import Record
from laglab_control.batch.impaired.sent import MOTION
from laglab_control.batch.impaired.timetable import ArrivalsNow, Whole
from laglab_control.batch.matrices import Symmetric, covariance_of
from laglab_control.batch.predicted import predicted
from laglab_control.batch.robots import Compared, Estimate, Robots, estimate_of
from laglab_control.batch.rows import Belief, headings
from laglab_control.motion import Motion, Way

IDENTITY = np.eye(3)
WHOLE = np.array([0, 1, 2, 1, 3, 4, 2, 4, 5])
"""Which of the six of a `Symmetric` stand where in the whole matrix."""
UPPER = np.array([0, 1, 2, 4, 5, 8])
"""And the way back."""


class Popf(Estimator):
    """`popf`; `innovation_at_k`: `popf-printed`."""

    def __init__(
        self, robots: Robots, record: Record, prior: Belief, innovation_at_k: bool = False
    ) -> None:
        timetable = record.timetable
        count, block = timetable.robots, max(timetable.least_delay, 1)
        depth = 2 * (timetable.reach + block + 1)
        self._robots, self._record, self._prior = robots, record, prior
        self._innovation_at_k = innovation_at_k
        self._priors, self._beliefs = Past(depth, MOTION, count), Past(depth, MOTION, count)
        self._weights = PastMatrices(depth, count)
        """S^-1 of what is measured at the prior."""
        self._left = PastMatrices(depth, count)
        """The product of I - K over a tick's corrections."""
        self._factors = Factors(block, depth, count)

    def go_on(self, tick: int, since: Whole) -> Sequence[Weighed]:
        """Each from its first input that was wrong."""
        for again in range(int(since.min(initial=tick)), tick):
            robots = np.flatnonzero(since <= again)
            self._predict(again, robots)
            for arrivals in self._record.timetable.arrivals_of(again, robots):
                self._correct(again, arrivals)
        self._predict(tick, self._record.everybody)
        return [
            Weighed(arrivals, self._compared(arrivals, self._correct(tick, arrivals)))
            for arrivals in self._record.timetable.arrivals[tick]
        ]

    def _predict(self, tick: int, robots: Whole) -> None:
        prior = self._predicted(tick - 1, robots) if tick else self._prior
        rows = np.array(prior)
        self._priors.keep_of(tick, robots, rows)
        self._beliefs.keep_of(tick, robots, rows)
        weights = self._robots.weights(covariance_of(prior))
        self._weights.keep(tick, robots, _whole(np.array(weights)))
        self._left.keep(tick, robots, IDENTITY)

    def _predicted(self, j: int, robots: Whole) -> Belief:
        """(27) from tick j to the next, and F_j."""
        before = Motion(*self._beliefs.of(j, robots))
        cosine, sine = headings(before.theta)
        u, F = self._record.inputs_of(j, robots), self._left.of(j, robots)
        distance = self._robots.model.sample_time * u.v
        led = np.array((-distance * sine, distance * cosine)).T
        F[:, :2] += led[:, :, None] * F[:, 2:]  # A (31) times the product of I - K
        self._factors.keep(j, robots, F)
        return predicted(self._robots.model, before, (cosine, sine), u)

    def _correct(self, tick: int, arrivals: ArrivalsNow) -> Rows:
        """(28); gives the innovations."""
        of, s, z = arrivals.robots, arrivals.s, self._record.measured(arrivals)
        prior, belief = self._priors.of(s, of), self._beliefs.of(tick, of)
        v, left = _less(z, prior), self._left.of(tick, of)
        cross = self._since(tick, arrivals, left) @ _whole(prior[3:])
        K = cross @ self._weights.of(s, of)  # (24)
        seen = _less(z, self._priors.of(tick, of)) if self._innovation_at_k else v
        belief[:3] += (K @ seen.T[:, :, None])[:, :, 0].T
        belief[3:] -= _upper(K @ cross.transpose(0, 2, 1).copy())  # (23)
        self._beliefs.keep_of(tick, of, belief)
        self._left.keep(tick, of, left - K @ left)
        return v

    def _compared(self, arrivals: ArrivalsNow, v: Rows) -> Compared:
        weights = _upper(self._weights.of(arrivals.s, arrivals.robots))
        return Compared(Way(*v), Symmetric(*weights))

    def _since(self, tick: int, arrivals: ArrivalsNow, left: Stack) -> Stack:
        """M* from each s to the present, after the corrections made so far."""
        late = arrivals.s < tick
        if late.all():
            return left @ self._factors.since(arrivals.s, tick, arrivals.robots)
        if late.any():
            s, robots = arrivals.s[late], arrivals.robots[late]
            left = left.copy()
            left[late] = left[late] @ self._factors.since(s, tick, robots)
        return left

    def estimate(self, tick: int) -> Estimate:
        """After its corrections."""
        return estimate_of(Motion(*self._beliefs.at(tick).copy()))


def _less(z: Rows, prior: Rows) -> Rows:
    """z - x, its heading wrapped."""
    v = z - prior[:3]
    v[2] = wrapped(v[2])
    return v


def _whole(P: Rows) -> Stack:
    """(6, robots) as matrices."""
    matrices: Stack = P.take(WHOLE, axis=0).T.reshape(-1, 3, 3)
    return matrices


def _upper(P: Stack) -> Rows:
    """And back."""
    rows: Rows = P.reshape(-1, 9).take(UPPER, axis=1).T
    return rows
