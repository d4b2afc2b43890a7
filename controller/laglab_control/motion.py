"""(3) is a product in SE(2): any stretch of it is one rigid motion."""

from typing import NamedTuple

import numpy as np

from laglab_control.angle import direction
from laglab_control.model import Matrix, Vector


class Motion(NamedTuple):
    """A rigid motion in the frame of its start, and the covariance of its end in that frame.

    Plain floats: at this size they are faster than arrays.
    """

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


class Way(NamedTuple):
    """Where a rigid motion leads, in the frame of its start; nothing of how surely."""

    x: float
    y: float
    theta: float


NOWHERE = Way(0.0, 0.0, 0.0)


def joined(first: Way, second: Way) -> Way:
    """x_a . x_b, as in `compose`."""
    x, y, theta = first
    along, across, turn = second
    c, s = direction(theta)
    dx, dy = c * along - s * across, s * along + c * across
    return Way(x + dx, y + dy, theta + turn)


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


def moved(x: Vector, P: Matrix, motion: Motion) -> tuple[Vector, Matrix]:
    """Where a pose x (3,) of covariance P (3, 3) gets by a motion: it is one from the origin."""
    start_x, start_y, start_theta = x.tolist()
    (xx, xy, xt), (_, yy, yt), (_, _, tt) = P.tolist()
    start = Motion(start_x, start_y, start_theta, xx, xy, xt, yy, yt, tt)
    end_x, end_y, end_theta, xx, xy, xt, yy, yt, tt = compose(start, motion)
    covariance = np.array((xx, xy, xt, xy, yy, yt, xt, yt, tt)).reshape(3, 3)
    return np.array((end_x, end_y, end_theta)), covariance
