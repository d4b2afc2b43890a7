"""The estimators for many robots, whose measurements all come m ticks late, each of them.

Each does what the one of its name does in `laglab_control.estimators`, where the reasons stand.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple, Protocol, TypeVar

from laglab_control.batch import matrices
from laglab_control.batch.matrices import IDENTITY, Square, Symmetric, covariance_of
from laglab_control.batch.robots import Compared, Robots
from laglab_control.batch.rows import Belief, Pose, Row, difference, headings, pose_of
from laglab_control.batch.turning import Turned, TurnedWay, Turning, nowhere, turned, way_of
from laglab_control.motion import Motion
from laglab_control.past.log import Log, append, logged
from laglab_control.past.sliding import SlidingProduct


class TurnedEstimate(NamedTuple):
    """Of the present."""

    pose: TurnedWay
    P: Symmetric | None
    """What is claimed for its error; None: nothing."""


def turned_estimate_of(belief: Turned) -> TurnedEstimate:
    """In two parts."""
    return TurnedEstimate(way_of(belief), covariance_of(belief.motion))


class Setting(NamedTuple):
    """What an estimator is told."""

    robots: Robots
    turning: Turning
    measurement_delay: int


S = TypeVar("S")


class BatchEstimator(Protocol[S]):
    """Predict once a tick, then correct, with z_{k-m} from tick m on; states are immutable."""

    def start(self, belief: Belief) -> S:
        """The prior of tick 0."""
        ...

    def predict(self, state: S, step: Turned) -> S:
        """One tick further, by the motions that the inputs applied meanwhile make."""
        ...

    def correct(self, state: S, z: Pose) -> tuple[S, Compared | None]:
        """With z_{k-m}, and what it was compared with."""
        ...

    def estimate(self, state: S) -> TurnedEstimate | None:
        """None: there is none."""
        ...


class Delayed(NamedTuple):
    """The EKF at the newest measurement's tick, and the motions from there to the present."""

    there: Turned
    window: SlidingProduct[Turned, Turned]
    measured: bool


@dataclass(frozen=True, eq=False)
class DelayedEkf(BatchEstimator[Delayed]):
    """`delayed-ekf`."""

    setting: Setting

    def start(self, belief: Belief) -> Delayed:
        composed = self.setting.turning.composed
        return Delayed(turned(belief), SlidingProduct(composed, nowhere()), measured=False)

    def predict(self, state: Delayed, step: Turned) -> Delayed:
        there, window, measured = state
        return Delayed(there, window.push(step, step), measured)

    def correct(self, state: Delayed, z: Pose) -> tuple[Delayed, Compared]:
        there, window, measured = state
        if measured:
            step, window = window.pop()
            there = self.setting.turning.composed(there, step)
        belief, compared = self.setting.robots.correct(there.motion, z)
        return Delayed(turned(belief), window, measured=True), compared

    def estimate(self, state: Delayed) -> TurnedEstimate:
        there, window, _ = state
        return turned_estimate_of(self.setting.turning.composed(there, window.product))


class Paper(NamedTuple):
    """The estimate, the priors of the last ticks, and M*'s factors since the oldest of them."""

    belief: Turned
    left: Square
    """I - K_k."""
    priors: Log[Belief]
    window: SlidingProduct[None, Square]
    length: int


@dataclass(frozen=True, eq=False)
class Popf(BatchEstimator[Paper]):
    """`popf`; `innovation_at_k`: `popf-printed`."""

    setting: Setting
    innovation_at_k: bool = False

    def start(self, belief: Belief) -> Paper:
        window: SlidingProduct[None, Square] = SlidingProduct(_later_to_the_left, IDENTITY)
        return Paper(turned(belief), IDENTITY, logged(belief), window, length=0)

    def predict(self, state: Paper, step: Turned) -> Paper:
        before, left, priors, window, length = state
        m = self.setting.measurement_delay
        belief, (cosine, sine) = self.setting.turning.composed(before, step), before.heading
        distance = step.motion.x
        window = window.push(None, _stepped(distance * cosine, distance * sine, left))
        if length == m:
            window = window.pop()[1]
        priors = append(priors, belief.motion, m + 1)
        return Paper(belief, IDENTITY, priors, window, min(length + 1, m))

    def correct(self, state: Paper, z: Pose) -> tuple[Paper, Compared]:
        (belief, _), _, priors, window, length = state
        m, robots = self.setting.measurement_delay, self.setting.robots
        prior = priors.items[priors.length - 1 - m]
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
        return Paper(turned(belief), left, priors, window, length), Compared(v, W)

    def estimate(self, state: Paper) -> TurnedEstimate:
        return turned_estimate_of(state.belief)


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
class Ekf(BatchEstimator[Turned]):
    """`ekf`: takes z_{k-m} for z_k."""

    setting: Setting

    def start(self, belief: Belief) -> Turned:
        return turned(belief)

    def predict(self, state: Turned, step: Turned) -> Turned:
        return self.setting.turning.composed(state, step)

    def correct(self, state: Turned, z: Pose) -> tuple[Turned, Compared]:
        belief, compared = self.setting.robots.correct(state.motion, z)
        return turned(belief), compared

    def estimate(self, state: Turned) -> TurnedEstimate:
        return turned_estimate_of(state)


@dataclass(frozen=True, eq=False)
class Raw(BatchEstimator[Pose | None]):
    """`raw`: the newest measurement."""

    setting: Setting

    def start(self, belief: Belief) -> None:
        return None

    def predict(self, state: Pose | None, step: Turned) -> Pose | None:
        return state

    def correct(self, state: Pose | None, z: Pose) -> tuple[Pose, None]:
        return z, None

    def estimate(self, state: Pose | None) -> TurnedEstimate | None:
        return (
            None if state is None else TurnedEstimate(TurnedWay(state, headings(state.theta)), None)
        )


BATCHED: Mapping[str, Callable[[Setting], BatchEstimator[Any]]] = {
    "raw": Raw,
    "ekf": Ekf,
    "popf": Popf,
    "popf-printed": partial(Popf, innovation_at_k=True),
    "delayed-ekf": DelayedEkf,
}
"""By name: those that there are for many robots."""
