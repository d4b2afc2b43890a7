"""The robot with some of its parameters unknown: (27) and its windows, of x and b together."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from laglab_control.angle import direction
from laglab_control.estimators.kalman import Belief
from laglab_control.estimators.parameters import Parameters
from laglab_control.model import Matrix, Vector
from laglab_control.motion import STILL, Motion, Way, compose
from laglab_control.robot import RobotModel

Slopes = tuple[tuple[float, float, float], ...]
"""The derivative of where a motion leads, [x, y, theta] in the frame of its start, by each b."""


class Learned(NamedTuple):
    """A motion at some b, and how it depends on b."""

    motion: Motion
    slopes: Slopes


@dataclass(frozen=True, eq=False)
class CalibratedMotions:
    """Windows of inputs to a robot with unknown parameters, linearised at b = `at` (p,).

    What is carried is x and b together, (3+p,); what comes out is x alone.
    """

    robot: RobotModel
    parameters: Parameters
    at: tuple[float, ...]

    @cached_property
    def identity(self) -> Learned:
        """Nowhere, whatever b is."""
        return Learned(STILL, ((0.0, 0.0, 0.0),) * len(self.at))

    def over(self, u: Vector) -> Learned:
        """g_k and its derivatives."""
        v, omega, by = self.parameters.taken(u, self.at)
        Ts = self.robot.sample_time
        motion = Motion(Ts * v, 0.0, Ts * omega, *self.robot.noise)
        return Learned(motion, tuple([(Ts * dv, 0.0, Ts * turn) for dv, turn in by]))

    def way(self, u: Vector) -> Way:
        """Where one tick leads."""
        v, omega, _ = self.parameters.taken(u, self.at)
        return Way(self.robot.sample_time * v, 0.0, self.robot.sample_time * omega)

    def compose(self, older: Learned, newer: Learned) -> Learned:
        """As motions; and the product of all [A, df/db] on the way."""
        first, second = older.motion, newer.motion
        whole = compose(first, second)
        dx, dy = whole.x - first.x, whole.y - first.y
        c, s = direction(first.theta)
        slopes = [
            (ax - dy * at + c * bx - s * by, ay + dx * at + s * bx + c * by, at + bt)
            for (ax, ay, at), (bx, by, bt) in zip(older.slopes, newer.slopes, strict=True)
        ]
        return Learned(whole, tuple(slopes))

    def carry(self, belief: Belief, window: Learned) -> Belief:
        """The pose (3,), (3, 3) at the end of the window."""
        end, F, noise = self.moved(belief.x, window)
        return Belief(np.array(end), F.dot(belief.P).dot(F.T) + noise)

    def moved(self, x: Vector, window: Learned) -> tuple[tuple[float, float, float], Matrix, Matrix]:
        """Where x and b (3+p,) lead, its derivative by them (3, 3+p), and the noise (3, 3)."""
        x_, y, theta, *b = x.tolist()
        (along, across, turn, xx, xy, xt, yy, yt, tt), slopes = window
        for value, at, (sx, sy, st) in zip(b, self.at, slopes, strict=True):
            along, across, turn = (
                along + sx * (value - at),
                across + sy * (value - at),
                turn + st * (value - at),
            )
        c, s = direction(theta)
        dx, dy = c * along - s * across, s * along + c * across
        F = np.array(
            (1.0, 0.0, -dy, *[c * sx - s * sy for sx, sy, _ in slopes])
            + (0.0, 1.0, dx, *[s * sx + c * sy for sx, sy, _ in slopes])
            + (0.0, 0.0, 1.0, *[st for _, _, st in slopes])
        ).reshape(3, len(x))
        cc, cs, ss = c * c, c * s, s * s
        xx, xy, yy = (
            cc * xx - 2 * cs * xy + ss * yy,
            cs * (xx - yy) + (cc - ss) * xy,
            ss * xx + 2 * cs * xy + cc * yy,
        )
        xt, yt = c * xt - s * yt, s * xt + c * yt
        noise = np.array((xx, xy, xt, xy, yy, yt, xt, yt, tt)).reshape(3, 3)
        return (x_ + dx, y + dy, theta + turn), F, noise


@dataclass(frozen=True, eq=False)
class CalibratedRobot:
    """The robot as a model whose state is [x, y, theta, b_1 ... b_p] (3+p,); z is its pose."""

    robot: RobotModel
    parameters: Parameters

    def predict(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """(27), linearised at the b of x; b walks."""
        b = x.tolist()[3:]
        motions = CalibratedMotions(self.robot, self.parameters, tuple(b))
        end, F, noise = motions.moved(x, motions.over(u))
        FP = F.dot(P)
        prior = P + self._walk
        prior[:3, :3] = FP.dot(F.T) + noise
        prior[:3, 3:] = FP[:, 3:]
        prior[3:, :3] = FP[:, 3:].T
        return np.array((*end, *b)), prior

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

    def A(self, x: Vector, u: Vector) -> Matrix:
        motions = CalibratedMotions(self.robot, self.parameters, tuple(x.tolist()[3:]))
        A = np.eye(len(x))
        A[:3] = motions.moved(x, motions.over(u))[1]
        return A

    @cached_property
    def _H(self) -> Matrix:
        return np.eye(3, 3 + len(self.parameters.deviations))

    @cached_property
    def _walk(self) -> Matrix:
        return np.diag(np.square((0.0, 0.0, 0.0, *self.parameters.walk)))
