"""The estimators for many robots, each of whose measurements comes exactly m ticks late.

Each does what the one of its name does in `laglab_control.estimators`, where the reasons stand.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from laglab_control.batch import matrices
from laglab_control.batch.matrices import IDENTITY, Square, Symmetric, covariance_of
from laglab_control.batch.odometry import (
    Leg,
    Rotation,
    Spread,
    at_origin,
    carried,
    spread,
    uncertain,
)
from laglab_control.batch.predicted import predicted
from laglab_control.batch.robots import Compared, Robots, composed
from laglab_control.batch.rows import Belief, Pose, Row, difference, headings, pose_of
from laglab_control.motion import STILL, Motion
from laglab_control.past.sliding import SlidingProduct


class Present(NamedTuple):
    """The estimates of the present."""

    pose: Pose
    turn: Rotation
    """From the headings of the odometers to those of the robots."""
    P: Symmetric | None
    """What is claimed for their errors; None: nothing."""


def present_of(belief: Belief, now: Leg) -> Present:
    """A belief in its parts; `now` is the leg at whose end it is."""
    return Present(pose_of(belief), Rotation.between(now, belief.theta), covariance_of(belief))


class Setting(NamedTuple):
    """What an estimator is told."""

    robots: Robots
    measurement_delay: int


S = TypeVar("S")


class BatchEstimator(Protocol[S]):
    """Predict once a tick, then correct, with z_{k-m} from tick m on; states are immutable."""

    def start(self, belief: Belief) -> S:
        """The prior of tick 0."""
        ...

    def predict(self, state: S, leg: Leg) -> S:
        """One tick further, by the inputs applied meanwhile."""
        ...

    def correct(self, state: S, z: Pose) -> tuple[S, Compared | None]:
        """By z_{k-m}; also what that was compared with."""
        ...

    def estimate(self, state: S, now: Leg) -> Present | None:
        """At the end of that leg; None: there is none."""
        ...


class Windowed(NamedTuple):
    """The EKF at the newest measurement's tick, and the motion from there to the present."""

    there: Belief
    window: SlidingProduct[Leg, Belief]
    measured: bool


@dataclass(frozen=True, eq=False)
class WindowedEkf(BatchEstimator[Windowed]):
    """`delayed-ekf`, its poses to the last bit."""

    setting: Setting

    def start(self, belief: Belief) -> Windowed:
        still: Belief = Motion(*[np.full(1, each) for each in STILL])
        return Windowed(belief, SlidingProduct(composed, still), measured=False)

    def predict(self, state: Windowed, leg: Leg) -> Windowed:
        there, window, measured = state
        return Windowed(there, window.push(leg, self.setting.robots.motion(leg.u)), measured)

    def correct(self, state: Windowed, z: Pose) -> tuple[Windowed, Compared]:
        there, window, measured = state
        robots = self.setting.robots
        if measured:
            leg, window = window.pop()
            there = composed(there, robots.motion(leg.u))
        there, compared = robots.correct(there, z)
        return Windowed(there, window, measured=True), compared

    def estimate(self, state: Windowed, now: Leg) -> Present:
        there, window, _ = state
        return present_of(composed(there, window.product), now)


class Delayed(NamedTuple):
    """The EKF at the newest measurement's tick, the leg that led there, and those from there on."""

    there: Belief
    at: Leg
    turn: Rotation
    legs: tuple[tuple[Leg, Spread], ...]
    since: int
    """How many of `legs` lead from there to the present."""
    sums: Spread
    """Over those."""
    measured: bool


@dataclass(frozen=True, eq=False)
class DelayedEkf(BatchEstimator[Delayed]):
    """`delayed-ekf`, as fast for long delays as for short ones."""

    setting: Setting

    def start(self, belief: Belief) -> Delayed:
        at = at_origin(len(belief.x))
        turn = Rotation.between(at, belief.theta)
        return Delayed(belief, at, turn, (), 0, np.zeros((7, len(belief.x))), measured=False)

    def predict(self, state: Delayed, leg: Leg) -> Delayed:
        there, at, turn, legs, since, sums, measured = state
        one = spread(self.setting.robots.model, leg)
        legs = (*legs, (leg, one))[-self.setting.measurement_delay - 1 :]
        return Delayed(there, at, turn, legs, since + 1, sums + one, measured)

    def correct(self, state: Delayed, z: Pose) -> tuple[Delayed, Compared]:
        there, at, turn, legs, since, sums, measured = state
        robots = self.setting.robots
        if measured:
            at, one = legs[-since]
            there = predicted(robots.model, there, turn.of(at.before), at.u)
            since, sums = since - 1, sums - one
        there, compared = robots.correct(there, z)
        turn = Rotation.between(at, there.theta)
        return Delayed(there, at, turn, legs, since, sums, measured=True), compared

    def estimate(self, state: Delayed, now: Leg) -> Present:
        there, at, turn, _, since, sums, _ = state
        P = uncertain(self.setting.robots.model, sums, since, now.end)
        belief = carried(there, turn, turn.way(at, now), P)
        return Present(pose_of(belief), turn, covariance_of(belief))


class Paper(NamedTuple):
    """The estimate, the priors of the last ticks, and M*'s factors since the oldest of them."""

    belief: Belief
    left: Square
    """I - K_k."""
    priors: tuple[Belief, ...]
    window: SlidingProduct[None, Square]
    length: int


@dataclass(frozen=True, eq=False)
class Popf(BatchEstimator[Paper]):
    """`popf`; `innovation_at_k`: `popf-printed`."""

    setting: Setting
    innovation_at_k: bool = False

    def start(self, belief: Belief) -> Paper:
        window: SlidingProduct[None, Square] = SlidingProduct(_later_to_the_left, IDENTITY)
        return Paper(belief, IDENTITY, (belief,), window, length=0)

    def predict(self, state: Paper, leg: Leg) -> Paper:
        before, left, priors, window, length = state
        m, model = self.setting.measurement_delay, self.setting.robots.model
        cosine, sine = heading = headings(before.theta)
        belief = predicted(model, before, heading, leg.u)
        distance = model.sample_time * leg.u.v
        window = window.push(None, _stepped(distance * cosine, distance * sine, left))
        if length == m:
            window = window.pop()[1]
        priors = (*priors, belief)[-m - 1 :]
        return Paper(belief, IDENTITY, priors, window, min(length + 1, m))

    def correct(self, state: Paper, z: Pose) -> tuple[Paper, Compared]:
        belief, _, priors, window, length = state
        m, robots = self.setting.measurement_delay, self.setting.robots
        prior = priors[-m - 1]
        P_s = covariance_of(prior)
        v, W = difference(z, pose_of(prior)), robots.weights(P_s)
        cross = matrices.whole(P_s)
        if m:
            cross = matrices.product(window.product, cross)
        K = matrices.product(cross, matrices.whole(W))  # (24)
        seen = difference(z, pose_of(belief)) if self.innovation_at_k else v
        d = matrices.times_vector(K, seen)
        P = matrices.less_outer(covariance_of(belief), K, cross)  # (23)
        belief = Motion(belief.x + d.x, belief.y + d.y, belief.theta + d.theta, *P)
        left = matrices.less_identity(K)
        return Paper(belief, left, priors, window, length), Compared(v, W)

    def estimate(self, state: Paper, now: Leg) -> Present:
        return present_of(state.belief, now)


def _later_to_the_left(older: Square, newer: Square) -> Square:
    return matrices.product(newer, older)


def _stepped(dx: Row, dy: Row, left: Square) -> Square:
    """A (31) times `left`, one factor of (21)."""
    xx, xy, xt, yx, yy, yt, tx, ty, tt = left
    return Square(
        *(xx - dy * tx, xy - dy * ty, xt - dy * tt),
        *(yx + dx * tx, yy + dx * ty, yt + dx * tt),
        *(tx, ty, tt),
    )


@dataclass(frozen=True, eq=False)
class Ekf(BatchEstimator[Belief]):
    """`ekf`: takes z_{k-m} for z_k."""

    setting: Setting

    def start(self, belief: Belief) -> Belief:
        return belief

    def predict(self, state: Belief, leg: Leg) -> Belief:
        return predicted(self.setting.robots.model, state, headings(state.theta), leg.u)

    def correct(self, state: Belief, z: Pose) -> tuple[Belief, Compared]:
        return self.setting.robots.correct(state, z)

    def estimate(self, state: Belief, now: Leg) -> Present:
        return present_of(state, now)


@dataclass(frozen=True, eq=False)
class Raw(BatchEstimator[Pose | None]):
    """`raw`: the newest measurement."""

    setting: Setting

    def start(self, belief: Belief) -> None:
        return None

    def predict(self, state: Pose | None, leg: Leg) -> Pose | None:
        return state

    def correct(self, state: Pose | None, z: Pose) -> tuple[Pose, None]:
        return z, None

    def estimate(self, state: Pose | None, now: Leg) -> Present | None:
        return None if state is None else Present(state, Rotation.between(now, state.theta), None)


BATCHED: Mapping[str, Callable[[Setting], BatchEstimator[Any]]] = {
    "raw": Raw,
    "ekf": Ekf,
    "popf": Popf,
    "popf-printed": partial(Popf, innovation_at_k=True),
    "delayed-ekf": DelayedEkf,
}
"""Those that there are for many robots, by name."""
