"""The robot's own window of inputs: (3) is a product in SE(2), and so is any stretch of it."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from laglab_controller.angle import direction
from laglab_controller.kalman import Belief
from laglab_controller.model import RobotModel, Vector


class Motion(NamedTuple):
    """A rigid motion in the frame of its start, and the covariance of its end in that frame."""

    x: float
    y: float
    theta: float
    p_xx: float = 0.0
    p_xy: float = 0.0
    p_xt: float = 0.0
    p_yy: float = 0.0
    p_yt: float = 0.0
    p_tt: float = 0.0


STILL = Motion(0.0, 0.0, 0.0)


def compose(first: Motion, second: Motion) -> Motion:
    """x_a . x_b: `second` starts where `first` ends.

    P = J P_a J^T + T P_b T^T, where T turns by first.theta, and J = [1 0 -dy; 0 1 dx; 0 0 1] is
    the product of all A (31) on the way: it depends only on where the way leads, (dx, dy).
    """
    x, y, theta, a_xx, a_xy, a_xt, a_yy, a_yt, a_tt = first
    along, across, turn, b_xx, b_xy, b_xt, b_yy, b_yt, b_tt = second
    c, s = direction(theta)
    dx, dy = c * along - s * across, s * along + c * across
    cc, cs, ss = c * c, c * s, s * s
    return Motion(
        x + dx,
        y + dy,
        theta + turn,
        a_xx - 2 * dy * a_xt + dy * dy * a_tt + cc * b_xx - 2 * cs * b_xy + ss * b_yy,
        a_xy + dx * a_xt - dy * a_yt - dx * dy * a_tt + cs * (b_xx - b_yy) + (cc - ss) * b_xy,
        a_xt - dy * a_tt + c * b_xt - s * b_yt,
        a_yy + 2 * dx * a_yt + dx * dx * a_tt + ss * b_xx + 2 * cs * b_xy + cc * b_yy,
        a_yt + dx * a_tt + s * b_xt + c * b_yt,
        a_tt + b_tt,
    )


@dataclass(frozen=True)
class RigidMotions:
    """The windows of the robot's inputs: each is one Motion, however long."""

    model: RobotModel
    identity: Motion = STILL

    @cached_property
    def noise(self) -> tuple[float, ...]:
        """W Q W^T (32) of one tick, in the frame of the robot: the same at every tick."""
        W = self.model.W(np.zeros(3))
        return tuple((W @ self.model.Q @ W.T)[np.triu_indices(3)].tolist())

    def over(self, u: Vector) -> Motion:
        """g_k = (Ts v, 0, Ts omega)."""
        v, omega = u.tolist()
        return Motion(self.model.sample_time * v, 0.0, self.model.sample_time * omega, *self.noise)

    def compose(self, older: Motion, newer: Motion) -> Motion:
        """One after the other."""
        return compose(older, newer)

    def carry(self, belief: Belief, window: Motion) -> Belief:
        """All of (27) over the window at once: the belief is itself a motion, from the origin."""
        start_x, start_y, start_theta = belief.x.tolist()
        (xx, xy, xt), (_, yy, yt), (_, _, tt) = belief.P.tolist()
        start = Motion(start_x, start_y, start_theta, xx, xy, xt, yy, yt, tt)
        x, y, theta, xx, xy, xt, yy, yt, tt = compose(start, window)
        return Belief(
            np.array((x, y, theta)),
            np.array(((xx, xy, xt), (xy, yy, yt), (xt, yt, tt))),
        )


def moved(pose: Vector, motion: Motion) -> Vector:
    """The pose (3,) at the end of a motion that starts at `pose`."""
    return np.array(compose(Motion(*pose.tolist()), motion)[:3])
