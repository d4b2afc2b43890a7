"""The estimators for many robots, whose measurements all come m ticks late, each of them.

Each does what the one of its name does in `laglab_control.estimators`, where the reasons stand.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from laglab_control.batch import matrices
from laglab_control.batch.matrices import IDENTITY, Square, Symmetric, covariance_of
from laglab_control.batch.rows import Belief, Pose, Row, Speeds, difference, headings, pose_of
from laglab_control.motion import Motion, Way, composed_along
from laglab_control.past.log import Log, append, logged
from laglab_control.past.sliding import SlidingProduct
from laglab_control.robot import RobotModel


class Compared(NamedTuple):
    """z_s - x^-_s, and the inverse of its claimed covariance S."""

    innovation: Pose
    weights: Symmetric


@dataclass(frozen=True, eq=False)
class Robots:
    """What the model says of many robots that are alike."""

    model: RobotModel

    @cached_property
    def _noise(self) -> list[Row]:
        return [np.array([each]) for each in self.model.noise]

    @cached_property
    def _variances(self) -> tuple[float, float, float]:
        x, y, theta = np.diag(self.model.R).tolist()
        return x, y, theta

    def motion(self, u: Speeds) -> Belief:
        """`RobotModel.motion`."""
        Ts = self.model.sample_time
        return Motion(Ts * u.v, np.zeros(1), Ts * u.omega, *self._noise)

    def way(self, u: Speeds) -> Pose:
        """`RobotModel.way`."""
        Ts = self.model.sample_time
        return Way(Ts * u.v, np.zeros(1), Ts * u.omega)

    def weights(self, P: Symmetric) -> Symmetric:
        """(P + R)^-1; R is diagonal."""
        x, y, theta = self._variances
        xx, xy, xt, yy, yt, tt = P
        return matrices.inverse(Symmetric(xx + x, xy, xt, yy + y, yt, tt + theta))

    def correct(self, prior: Belief, z: Pose) -> tuple[Belief, Compared]:
        """(8): K = P S^-1, and P+ = P - P S^-1 P = R - R S^-1 R."""
        P = covariance_of(prior)
        v, W = difference(z, pose_of(prior)), self.weights(P)
        d = matrices.times_vector(matrices.whole(P), matrices.times_vector(matrices.whole(W), v))
        x, y, t = self._variances
        posterior = Motion(
            *(prior.x + d.x, prior.y + d.y, prior.theta + d.theta),
            *(x - x * x * W.xx, -x * y * W.xy, -x * t * W.xt),
            *(y - y * y * W.yy, -y * t * W.yt, t - t * t * W.tt),
        )
        return posterior, Compared(v, W)


def composed(first: Belief, second: Belief) -> Belief:
    """Two windows in a row; of a belief and a window (27), over one tick or over many."""
    return composed_along(headings(first.theta), first, second)


class Estimate(NamedTuple):
    """Of the present."""

    pose: Pose
    P: Symmetric | None
    """What is claimed for its error; None: nothing."""


def estimate_of(belief: Belief) -> Estimate:
    """In two parts."""
    return Estimate(pose_of(belief), covariance_of(belief))


S = TypeVar("S")


class BatchEstimator(Protocol[S]):
    """Predict once a tick, then correct, with z_{k-m} from tick m on; states are immutable."""

    def start(self, belief: Belief) -> S:
        """The prior of tick 0."""
        ...

    def predict(self, state: S, u: Speeds) -> S:
        """One tick further, with the inputs applied meanwhile."""
        ...

    def correct(self, state: S, z: Pose) -> tuple[S, Compared | None]:
        """With z_{k-m}, and what it was compared with."""
        ...

    def estimate(self, state: S) -> Estimate | None:
        """None: there is none."""
        ...


class Delayed(NamedTuple):
    """The EKF at the newest measurement's tick, and the inputs from there to the present."""

    there: Belief
    window: SlidingProduct[Speeds, Belief]
    measured: bool


@dataclass(frozen=True, eq=False)
class DelayedEkf(BatchEstimator[Delayed]):
    """`delayed-ekf`."""

    robots: Robots
    measurement_delay: int

    def start(self, belief: Belief) -> Delayed:
        nothing = Motion(*[np.zeros(1)] * 9)
        return Delayed(belief, SlidingProduct(composed, nothing), measured=False)

    def predict(self, state: Delayed, u: Speeds) -> Delayed:
        return state._replace(window=state.window.push(u, self.robots.motion(u)))

    def correct(self, state: Delayed, z: Pose) -> tuple[Delayed, Compared]:
        there, window, measured = state
        if measured:
            u, window = window.pop()
            there = composed(there, self.robots.motion(u))
        there, compared = self.robots.correct(there, z)
        return Delayed(there, window, measured=True), compared

    def estimate(self, state: Delayed) -> Estimate:
        return estimate_of(composed(state.there, state.window.product))


class Paper(NamedTuple):
    """The estimate, the priors of the last ticks, and M*'s factors since the oldest of them."""

    belief: Belief
    left: Square
    """I - K_k."""
    priors: Log[Belief]
    window: SlidingProduct[None, Square]
    length: int


@dataclass(frozen=True, eq=False)
class Popf(BatchEstimator[Paper]):
    """`popf`; `innovation_at_k`: `popf-printed`."""

    robots: Robots
    measurement_delay: int
    innovation_at_k: bool = False

    def start(self, belief: Belief) -> Paper:
        window: SlidingProduct[None, Square] = SlidingProduct(_later_to_the_left, IDENTITY)
        return Paper(belief, IDENTITY, logged(belief), window, length=0)

    def predict(self, state: Paper, u: Speeds) -> Paper:
        before, left, priors, window, length = state
        cosine, sine = headings(before.theta)
        belief = composed_along((cosine, sine), before, self.robots.motion(u))
        distance = self.robots.model.sample_time * u.v
        factor = _stepped(distance * cosine, distance * sine, left)
        window, length = window.push(None, factor), length + 1
        if length > self.measurement_delay:
            (_, window), length = window.pop(), length - 1
        priors = append(priors, belief, self.measurement_delay + 1)
        return Paper(belief, IDENTITY, priors, window, length)

    def correct(self, state: Paper, z: Pose) -> tuple[Paper, Compared]:
        belief, _, priors, window, length = state
        prior = priors.items[priors.length - 1 - self.measurement_delay]
        P_s = covariance_of(prior)
        v, W = difference(z, pose_of(prior)), self.robots.weights(P_s)
        cross = matrices.whole(P_s)
        if self.measurement_delay:
            cross = matrices.product(window.product, cross)
        K = matrices.product(cross, matrices.whole(W))  # (24)
        seen = difference(z, pose_of(belief)) if self.innovation_at_k else v
        d = matrices.times_vector(K, seen)
        P = matrices.less_outer(covariance_of(belief), K, cross)  # (23)
        belief = Motion(belief.x + d.x, belief.y + d.y, belief.theta + d.theta, *P)
        left = matrices.less_identity(K)
        return Paper(belief, left, priors, window, length), Compared(v, W)

    def estimate(self, state: Paper) -> Estimate:
        return estimate_of(state.belief)


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

    robots: Robots

    def start(self, belief: Belief) -> Belief:
        return belief

    def predict(self, state: Belief, u: Speeds) -> Belief:
        return composed(state, self.robots.motion(u))

    def correct(self, state: Belief, z: Pose) -> tuple[Belief, Compared]:
        return self.robots.correct(state, z)

    def estimate(self, state: Belief) -> Estimate:
        return estimate_of(state)


@dataclass(frozen=True, eq=False)
class Raw(BatchEstimator[Pose | None]):
    """`raw`: the newest measurement."""

    def start(self, belief: Belief) -> None:
        return None

    def predict(self, state: Pose | None, u: Speeds) -> Pose | None:
        return state

    def correct(self, state: Pose | None, z: Pose) -> tuple[Pose, None]:
        return z, None

    def estimate(self, state: Pose | None) -> Estimate | None:
        return None if state is None else Estimate(state, None)


BATCHED: Mapping[str, Callable[[Robots, int], BatchEstimator[Any]]] = {
    "raw": lambda _, __: Raw(),
    "ekf": lambda robots, _: Ekf(robots),
    "popf": Popf,
    "popf-printed": partial(Popf, innovation_at_k=True),
    "delayed-ekf": DelayedEkf,
}
"""By name: those that there are for many robots."""
