"""`popf` and `popf-printed` for many robots whose measurements come when they do."""

from collections.abc import Sequence

import numpy as np

from laglab_control.batch import matrices
from laglab_control.batch.estimators import Compared, Estimate, Robots, composed, estimate_of
from laglab_control.batch.impaired.estimators import Estimator, Weighed
from laglab_control.batch.impaired.past import Past
from laglab_control.batch.impaired.record import Record
from laglab_control.batch.impaired.sent import MOTION
from laglab_control.batch.impaired.timetable import ArrivalsNow, Whole
from laglab_control.batch.matrices import Square, covariance_of
from laglab_control.batch.rows import Belief, Pose, Row, Speeds, difference, headings, pose_of
from laglab_control.motion import Motion

SQUARE = 9
"""Rows of one."""


class Factors:
    """(21): products of F_j = A_j (I - K_j), which take tick j to j + 1, later ones to the left.

    The ticks are cut in blocks no longer than the least delay. Of each block the products from its
    begin on and up to its end are kept; so every M* from tick s to t is a product of a few of them,
    and a factor that changes changes only its own block's.
    """

    def __init__(self, block: int, depth: int, robots: int) -> None:
        self._block = block
        self._factors = Past(depth, SQUARE, robots)
        self._from_begin = Past(depth, SQUARE, robots)
        """F_{t-1} ... F_b, b the begin of the block of t."""
        self._to_end = Past(depth, SQUARE, robots)
        """F_{e-1} ... F_s, e the end of the block of s."""

    def keep(self, j: int, factor: Square) -> None:
        """F_j, when all before it are right."""
        self._factors.keep(j, factor)
        if (j + 1) % self._block:
            before = factor if j % self._block == 0 else self._later(factor, self._from_begin, j)
            self._from_begin.keep(j + 1, before)
        else:
            self._end(j)

    def _end(self, j: int) -> None:
        """Of a block."""
        product = Square(*self._factors.at(j))
        self._to_end.keep(j, product)
        for older in range(j - 1, j - self._block, -1):
            product = matrices.product(product, Square(*self._factors.at(older)))
            self._to_end.keep(older, product)

    def _later(self, factor: Square, past: Past, tick: int) -> Square:
        return matrices.product(factor, Square(*past.at(tick)))

    def since(self, s: Whole, tick: int, robots: Whole) -> Square:
        """M* of these robots, each from its own s of an earlier block to `tick`."""
        block = self._block
        product = Square(*self._to_end.of(s, robots))
        between = tick // block - 1 - s // block
        for i in range(int(between.max())):
            begin = (s // block + 1 + i) * block
            whole = Square(*self._to_end.of(begin, robots))
            longer = matrices.product(whole, product)
            there = between > i
            product = Square(
                *[np.where(there, *pair) for pair in zip(longer, product, strict=True)]
            )
        if tick % block:
            newest = Square(*self._from_begin.at(tick)[:, robots])
            product = matrices.product(newest, product)
        return product


class Popf(Estimator):
    """`popf`; `innovation_at_k`: `popf-printed`."""

    def __init__(
        self, robots: Robots, record: Record, prior: Belief, innovation_at_k: bool = False
    ) -> None:
        timetable = record.timetable
        count, block = timetable.robots, max(timetable.least_delay, 1)
        depth = 2 * timetable.reach + 2 * block + 2
        self._robots, self._record, self._prior = robots, record, prior
        self._innovation_at_k = innovation_at_k
        self._priors, self._beliefs = Past(depth, MOTION, count), Past(depth, MOTION, count)
        self._left = Past(depth, SQUARE, count)
        """The product of I - K over a tick's corrections."""
        self._factors = Factors(block, depth, count)

    def go_on(self, tick: int, since: Whole) -> Sequence[Weighed]:
        """From the first input that was wrong."""
        weighed: list[Weighed] = []
        for again in range(min(int(since.min()), tick), tick + 1):
            weighed = self._go_through(again)
        return weighed

    def _go_through(self, tick: int) -> list[Weighed]:
        prior = self._predicted(tick - 1) if tick else self._prior
        self._priors.keep(tick, prior)
        self._beliefs.keep(tick, prior)
        self._left.keep(tick, matrices.identities(self._record.timetable.robots))
        return [
            Weighed(arrivals, self._correct(tick, arrivals))
            for arrivals in self._record.timetable.arrivals[tick]
        ]

    def _predicted(self, j: int) -> Belief:
        """(27) from tick j to the next, and F_j."""
        before, u = Motion(*self._beliefs.at(j)), self._record.inputs(j)
        self._factors.keep(j, self._factor(headings(before.theta), u, Square(*self._left.at(j))))
        return composed(before, self._robots.motion(u))

    def _factor(self, heading: tuple[Row, Row], u: Speeds, left: Square) -> Square:
        """A (31) times `left`, one factor of (21)."""
        distance = self._robots.model.sample_time * u.v
        return matrices.sheared(distance * heading[0], distance * heading[1], left)

    def _correct(self, tick: int, arrivals: ArrivalsNow) -> Compared:
        """(28)."""
        of, s, z = arrivals.robots, arrivals.s, self._record.measured(arrivals)
        rows, left = self._beliefs.at(tick), self._left.at(tick)
        belief = Motion(*rows[:, of])
        prior = Motion(*self._priors.of(s, of))
        v, W = difference(z, pose_of(prior)), self._robots.weights(covariance_of(prior))
        so_far = Square(*left[:, of])
        cross = matrices.product(
            self._since(tick, arrivals, so_far), matrices.whole(covariance_of(prior))
        )
        K = matrices.product(cross, matrices.whole(W))  # (24)
        d = matrices.times_vector(K, self._seen(tick, of, z) if self._innovation_at_k else v)
        P = matrices.less_outer(covariance_of(belief), K, cross)  # (23)
        rows[:, of] = belief.x + d.x, belief.y + d.y, belief.theta + d.theta, *P
        left[:, of] = matrices.product(matrices.less_identity(K), so_far)
        return Compared(v, W)

    def _since(self, tick: int, arrivals: ArrivalsNow, left: Square) -> Square:
        """M* from each s to the present, after the corrections made so far."""
        late = arrivals.s < tick
        if not late.any():
            return left
        if late.all():
            return matrices.product(left, self._factors.since(arrivals.s, tick, arrivals.robots))
        earlier = self._factors.since(np.minimum(arrivals.s, tick - 1), tick, arrivals.robots)
        product = matrices.product(left, earlier)
        return Square(*[np.where(late, *pair) for pair in zip(product, left, strict=True)])

    def _seen(self, tick: int, of: Whole, z: Pose) -> Pose:
        """(28) as printed."""
        return difference(z, pose_of(Motion(*self._priors.at(tick)[:, of])))

    def estimate(self, tick: int) -> Estimate:
        """After its corrections."""
        return estimate_of(Motion(*self._beliefs.at(tick).copy()))
