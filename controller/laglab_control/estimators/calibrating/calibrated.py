"""The robot with parameters that are not known: (27) and its windows, of x and b together."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from laglab_control.angle import direction
from laglab_control.estimators.calibrating.parameters import Parameters
from laglab_control.estimators.kalman import Belief
from laglab_control.model import Matrix, Vector, constant
from laglab_control.motion import STILL, Motion, Way, compose
from laglab_control.robot import RobotModel

Slopes = Sequence[tuple[float, float, float]]
"""The derivative of a motion's x, y and theta, in the frame of its start, by each b."""


class Learned(NamedTuple):
    """A motion at b = `at` (p,), and how it depends on b."""

    motion: Motion[float]
    slopes: Slopes
    at: Sequence[float]


class Moved(NamedTuple):
    """Where a pose gets by a motion whose b is not known."""

    pose: tuple[float, float, float]
    A: tuple[float, ...]
    """Its derivative by x and b (3, 3+p), row by row."""
    noise: tuple[float, ...]
    """The covariance (3, 3) that the motion adds, row by row."""


@dataclass(frozen=True, eq=False)
class CalibratedMotions:
    """Windows of inputs to a robot with parameters b (p,), linearised at b = `at`.

    What is carried is x and b together (3+p,), what comes out x alone. b does not walk meanwhile.
    """

    robot: RobotModel
    parameters: Parameters
    at: Sequence[float]

    @property
    def identity(self) -> Learned:
        """Nowhere, whatever b is."""
        return Learned(STILL, ((0.0, 0.0, 0.0),) * len(self.at), self.at)

    def over(self, u: Vector) -> Learned:
        """g_k, and its derivatives."""
        return _step(self.robot, self.parameters, u, self.at)

    def way(self, u: Vector) -> Way[float]:
        """Where one tick leads."""
        return Way(*self.over(u).motion[:3])

    def compose(self, older: Learned, newer: Learned) -> Learned:
        """Both motions, and the chain rule for the slopes; at the newer b."""
        b = newer.at
        first = older.motion if older.at is b else _moved_to(older, b)
        whole = compose(first, newer.motion)
        c, s = direction(first.theta)
        dx, dy = whole.x - first.x, whole.y - first.y
        slopes = [
            (ax - dy * at + c * bx - s * by, ay + dx * at + s * bx + c * by, at + bt)
            for (ax, ay, at), (bx, by, bt) in zip(older.slopes, newer.slopes, strict=True)
        ]
        return Learned(whole, slopes, b)

    def carry(self, belief: Belief, window: Learned) -> Belief:
        """The pose (3,), (3, 3) at the end of the window."""
        x = belief.x.tolist()
        pose, A, noise = _moved(x, _moved_to(window, x[3:]), window.slopes)
        F = np.array(A).reshape(3, len(x))
        return Belief(np.array(pose), F.dot(belief.P).dot(F.T) + np.array(noise).reshape(3, 3))


@dataclass(frozen=True, eq=False)
class CalibratedRobot:
    """The robot as a model whose state is [x, y, theta, b_1 ... b_p] (3+p,); z is its pose."""

    robot: RobotModel
    parameters: Parameters

    def predict(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """(27), linearised at the b of x; b walks."""
        known = x.tolist()
        b = known[3:]
        motion, slopes, _ = _step(self.robot, self.parameters, u, b)
        pose, A, noise = _moved(known, motion, slopes)
        F = np.array(A + self._constant).reshape(P.shape)
        prior = F.dot(P).dot(F.T)
        prior[:3, :3] += np.array(noise).reshape(3, 3)
        for i, variance in enumerate(self.parameters.walk(u), start=3):
            prior[i, i] += self.robot.sample_time * variance
        return np.array((*pose, *b)), prior

    def A(self, x: Vector, u: Vector) -> Matrix:
        """(31), beside it the slopes, and b as it was."""
        known = x.tolist()
        motion, slopes, _ = _step(self.robot, self.parameters, u, known[3:])
        A = _moved(known, motion, slopes).A + self._constant
        return np.reshape(A, (len(known), len(known)))

    def h(self, x: Vector) -> Vector:
        """The pose."""
        return x[:3]

    def H(self, x: Vector) -> Matrix:
        """[I, 0]."""
        return self._H

    def measurement_noise(self, x: Vector) -> Matrix:
        """R."""
        return self.robot.R

    def innovation(self, z: Vector, expected: Vector) -> Vector:
        """z - expected with the heading wrapped."""
        return self.robot.innovation(z, expected)

    @cached_property
    def _constant(self) -> tuple[float, ...]:
        """The rows of A that b has, one after the other: it stays what it is."""
        size = 3 + len(self.parameters.deviations)
        return tuple(np.eye(size)[3:].ravel().tolist())

    @cached_property
    def _H(self) -> Matrix:
        shape = (3, 3 + len(self.parameters.deviations))
        return constant(np.eye(*shape), shape, "H")


def _step(robot: RobotModel, parameters: Parameters, u: Vector, b: Sequence[float]) -> Learned:
    """One tick with input u."""
    v, omega, by = parameters.taken(u, b)
    Ts = robot.sample_time
    motion = Motion(Ts * v, 0.0, Ts * omega, *robot.noise)
    return Learned(motion, [(Ts * dv, 0.0, Ts * turn) for dv, turn in by], b)


def _moved_to(window: Learned, b: Sequence[float]) -> Motion[float]:
    """The window's motion at another b, to first order."""
    (x, y, theta, *noise), slopes, at = window
    for value, was, (by_x, by_y, by_theta) in zip(b, at, slopes, strict=True):
        off = value - was
        x, y, theta = x + by_x * off, y + by_y * off, theta + by_theta * off
    return Motion(x, y, theta, *noise)


def _moved(x: Sequence[float], motion: Motion[float], slopes: Slopes) -> Moved:
    """The motion turned by theta: A is J of `compose`, beside it the slopes turned."""
    start_x, start_y, theta = x[:3]
    along, across, turn, xx, xy, xt, yy, yt, tt = motion
    c, s = direction(theta)
    dx, dy = c * along - s * across, s * along + c * across
    turned = [(c * sx - s * sy, s * sx + c * sy, st) for sx, sy, st in slopes]
    by_x, by_y, by_theta = zip(*turned, strict=True)
    A = (1.0, 0.0, -dy, *by_x, 0.0, 1.0, dx, *by_y, 0.0, 0.0, 1.0, *by_theta)
    cc, cs, ss = c * c, c * s, s * s
    xx, xy, yy = (
        cc * xx - 2 * cs * xy + ss * yy,
        cs * (xx - yy) + (cc - ss) * xy,
        ss * xx + 2 * cs * xy + cc * yy,
    )
    xt, yt = c * xt - s * yt, s * xt + c * yt
    noise = (xx, xy, xt, xy, yy, yt, xt, yt, tt)
    return Moved((start_x + dx, start_y + dy, theta + turn), A, noise)
