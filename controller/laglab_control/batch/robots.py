"""What the model says of many robots that are alike, and what is known of them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch import matrices
from laglab_control.batch.matrices import Symmetric, covariance_of
from laglab_control.batch.rows import Belief, Pose, Row, Speeds, difference, headings, pose_of
from laglab_control.config import FAR, StationConfig
from laglab_control.errors import ConfigError
from laglab_control.model import Matrix
from laglab_control.motion import Motion, composed_along, joined_along
from laglab_control.robot import RobotModel


class Compared(NamedTuple):
    """z_s - x^-_s, and the inverse of its claimed covariance S."""

    innovation: Pose
    weights: Symmetric


class Estimate(NamedTuple):
    """Of the present."""

    pose: Pose
    P: Symmetric | None
    """What is claimed for its error; None: nothing."""


def estimate_of(belief: Belief) -> Estimate:
    """A belief in its two parts."""
    return Estimate(pose_of(belief), covariance_of(belief))


def composed(first: Belief, second: Belief) -> Belief:
    """Two windows in a row; of a belief and a window (27), over one tick or over many."""
    return composed_along(headings(first.theta), first, second)


def joined(first: Pose, second: Pose) -> Pose:
    """Two ways in a row."""
    return joined_along(headings(first.theta), first, second)


def prior_of(config: StationConfig, initial_estimates: Matrix) -> Belief:
    """Of tick 0: the poses (3, robots), and P_0."""
    x, y, theta = np.array(initial_estimates)
    P = np.asarray(config.initial_covariance)[np.triu_indices(3)]
    return Motion(x, y, theta, *[np.full(len(x), each) for each in P])


def diverged(pose: Pose, goal: Sequence[float], began: Matrix) -> NDArray[np.bool_]:
    """Not finite, or FAR from where it began and from the goal."""
    near = _within(pose, *goal[:2])
    if not near.all():
        near |= _within(pose, *began[:2])
    return ~(near & np.isfinite(pose.theta))


def _within(pose: Pose, x: Row | float, y: Row | float) -> NDArray[np.bool_]:
    dx, dy = pose.x - x, pose.y - y
    return dx * dx + dy * dy <= FAR**2


@dataclass(frozen=True, eq=False)
class Robots:
    """Their sensor's errors in x, y and theta are independent: R is diagonal.

    Raises ConfigError when it is not.
    """

    model: RobotModel

    def __post_init__(self) -> None:
        if np.any(np.diag(np.diag(self.model.R)) != self.model.R):
            raise ConfigError("R must be diagonal for many robots")

    @cached_property
    def _noise(self) -> list[Row]:
        return [np.array([each]) for each in self.model.noise]

    @cached_property
    def _variances(self) -> tuple[float, float, float]:
        x, y, theta = np.diag(self.model.R).tolist()
        return x, y, theta

    @cached_property
    def wheels_are_alike(self) -> bool:
        """Whether the noise of their sum is independent of that of their difference."""
        along, _, together, _, _, turning = self.model.noise
        return abs(together) <= 1e-12 * math.sqrt(along * turning)

    def motion(self, u: Speeds) -> Belief:
        """One tick of (3): `RobotModel.motion`."""
        Ts = self.model.sample_time
        return Motion(Ts * u.v, np.zeros(1), Ts * u.omega, *self._noise)

    def weights(self, P: Symmetric) -> Symmetric:
        """S^-1 = (P + R)^-1."""
        x, y, theta = self._variances
        xx, xy, xt, yy, yt, tt = P
        return matrices.inverse(Symmetric(xx + x, xy, xt, yy + y, yt, tt + theta))

    def correct(self, prior: Belief, z: Pose) -> tuple[Belief, Compared]:
        """(8): K = P S^-1 = I - R S^-1, and P+ = P - P S^-1 P = R - R S^-1 R."""
        v, W = difference(z, pose_of(prior)), self.weights(covariance_of(prior))
        d = matrices.times_vector(matrices.whole(W), v)
        for each, variance, seen, before in zip(d, self._variances, v, prior, strict=False):
            each *= -variance
            each += seen
            each += before
        x, y, t = self._variances
        xx, xy, xt, yy, yt, tt = W
        P = xx * -(x * x), xy * -(x * y), xt * -(x * t), yy * -(y * y), yt * -(y * t), tt * -(t * t)
        for i, variance in zip((0, 3, 5), self._variances, strict=True):
            P[i][:] += variance
        return Motion(*d, *P), Compared(v, W)
