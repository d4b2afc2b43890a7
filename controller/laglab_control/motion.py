"""(3) is a product in SE(2): any stretch of it is one rigid motion."""

from typing import Generic, NamedTuple, TypeVar

import numpy as np

from laglab_control.angle import direction
from laglab_control.model import Matrix, Vector

F = TypeVar("F", float, Vector)
"""A number of one robot, or those of many."""


class Motion(NamedTuple, Generic[F]):
    """A rigid motion [m, m, rad] in the frame of its start, and the covariance of its end there.

    Of one robot in plain floats: at this size they are faster than arrays.
    """

    x: F
    y: F
    theta: F
    p_xx: F
    p_xy: F
    p_xt: F
    p_yy: F
    p_yt: F
    p_tt: F


STILL = Motion(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Way(NamedTuple, Generic[F]):
    """Where a rigid motion leads [m, m, rad], in the frame of its start; nothing of how surely."""

    x: F
    y: F
    theta: F


NOWHERE = Way(0.0, 0.0, 0.0)


def joined(first: Way[float], second: Way[float]) -> Way[float]:
    """x_a . x_b, as in `compose`."""
    return joined_along(direction(first.theta), first, second)


def joined_along(heading: tuple[F, F], first: Way[F], second: Way[F]) -> Way[F]:
    """The same, given the cosine and sine of first.theta."""
    x, y, theta = first
    along, across, turn = second
    c, s = heading
    dx, dy = c * along - s * across, s * along + c * across
    return Way(x + dx, y + dy, theta + turn)


def compose(first: Motion[float], second: Motion[float]) -> Motion[float]:
    """x_a . x_b: `second` starts where `first` ends.

    P = J P_a J^T + T P_b T^T, where T turns by first.theta, and J = [1 0 -dy; 0 1 dx; 0 0 1] is
    the product of all A (31) on the way: it depends only on where the way leads, (dx, dy).
    """
    return composed_along(direction(first.theta), first, second)


def composed_along(heading: tuple[F, F], first: Motion[F], second: Motion[F]) -> Motion[F]:
    """The same, given the cosine and sine of first.theta."""
    x, y, theta, a_xx, a_xy, a_xt, a_yy, a_yt, a_tt = first
    along, across, turn, b_xx, b_xy, b_xt, b_yy, b_yt, b_tt = second
    c, s = heading
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


def moved(x: Vector, P: Matrix, motion: Motion[float]) -> tuple[Vector, Matrix]:
    """Where a pose x (3,), P (3, 3) gets by a motion: a pose is itself a motion from the origin."""
    start_x, start_y, start_theta = x.tolist()
    (xx, xy, xt), (_, yy, yt), (_, _, tt) = P.tolist()
    start = Motion(start_x, start_y, start_theta, xx, xy, xt, yy, yt, tt)
    end_x, end_y, end_theta, xx, xy, xt, yy, yt, tt = compose(start, motion)
    covariance = np.array((xx, xy, xt, xy, yy, yt, xt, yt, tt)).reshape(3, 3)
    return np.array((end_x, end_y, end_theta)), covariance
