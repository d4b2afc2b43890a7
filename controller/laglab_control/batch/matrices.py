"""Matrices (3, 3) of many robots, element by element.

A sum is gathered in its first product (`a = b * c; a -= d * e`): half of what such short arrays
cost is the memory for the next one.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from laglab_control.batch.rows import Belief, Pose, Row
from laglab_control.motion import Way


class Symmetric(NamedTuple):
    """The upper triangle."""

    xx: Row
    xy: Row
    xt: Row
    yy: Row
    yt: Row
    tt: Row


class Square(NamedTuple):
    """Row by row."""

    xx: Row
    xy: Row
    xt: Row
    yx: Row
    yy: Row
    yt: Row
    tx: Row
    ty: Row
    tt: Row


_ZERO, _ONE = np.zeros(1), np.ones(1)
IDENTITY = Square(_ONE, _ZERO, _ZERO, _ZERO, _ONE, _ZERO, _ZERO, _ZERO, _ONE)


def covariance_of(belief: Belief) -> Symmetric:
    """P."""
    return Symmetric(*belief[3:])


def inverse(S: Symmetric) -> Symmetric:
    """By cofactors; of positive definite ones."""
    xx, xy, xt, yy, yt, tt = S
    c_xx, c_xy, c_xt = _minor(yy, tt, yt, yt), _minor(xt, yt, xy, tt), _minor(xy, yt, xt, yy)
    c_yy, c_yt, c_tt = _minor(xx, tt, xt, xt), _minor(xy, xt, xx, yt), _minor(xx, yy, xy, xy)
    scale = xx * c_xx
    scale += xy * c_xy
    scale += xt * c_xt
    np.divide(1.0, scale, scale)
    for cofactor in (c_xx, c_xy, c_xt, c_yy, c_yt, c_tt):
        cofactor *= scale
    return Symmetric(c_xx, c_xy, c_xt, c_yy, c_yt, c_tt)


def _minor(a: Row, b: Row, c: Row, d: Row) -> Row:
    """a b - c d."""
    minor = a * b
    minor -= c * d
    return minor


def times_vector(K: Square, v: Pose) -> Pose:
    """K v."""
    return Way(*[_dot(row, v) for row in (K[:3], K[3:6], K[6:])])


def _dot(row: Sequence[Row], v: Pose) -> Row:
    a, b, c = row
    total = a * v.x
    total += b * v.y
    total += c * v.theta
    return total


def whole(P: Symmetric) -> Square:
    """With its lower triangle."""
    xx, xy, xt, yy, yt, tt = P
    return Square(xx, xy, xt, xy, yy, yt, xt, yt, tt)


def product(A: Square, B: Square) -> Square:
    """A B."""
    return Square(
        A.xx * B.xx + A.xy * B.yx + A.xt * B.tx,
        A.xx * B.xy + A.xy * B.yy + A.xt * B.ty,
        A.xx * B.xt + A.xy * B.yt + A.xt * B.tt,
        A.yx * B.xx + A.yy * B.yx + A.yt * B.tx,
        A.yx * B.xy + A.yy * B.yy + A.yt * B.ty,
        A.yx * B.xt + A.yy * B.yt + A.yt * B.tt,
        A.tx * B.xx + A.ty * B.yx + A.tt * B.tx,
        A.tx * B.xy + A.ty * B.yy + A.tt * B.ty,
        A.tx * B.xt + A.ty * B.yt + A.tt * B.tt,
    )


def led(P: Symmetric, dx: Row, dy: Row) -> Symmetric:
    """J P J^T, J = [1 0 -dy; 0 1 dx; 0 0 1] (`compose`): all but tt in arrays of its own."""
    xx, xy, xt, yy, yt, tt = P
    xt_led, yt_led = dy * tt, dx * tt
    np.subtract(xt, xt_led, xt_led)
    yt_led += yt
    xx_led, xy_led, yy_led = dy * (xt + xt_led), dx * xt_led, dx * (yt + yt_led)
    np.subtract(xx, xx_led, xx_led)
    xy_led -= dy * yt
    xy_led += xy
    yy_led += yy
    return Symmetric(xx_led, xy_led, xt_led, yy_led, yt_led, tt)


def less_outer(P: Symmetric, K: Square, cross: Square) -> Symmetric:
    """P - K cross^T, which is symmetric."""
    return Symmetric(
        P.xx - (K.xx * cross.xx + K.xy * cross.xy + K.xt * cross.xt),
        P.xy - (K.xx * cross.yx + K.xy * cross.yy + K.xt * cross.yt),
        P.xt - (K.xx * cross.tx + K.xy * cross.ty + K.xt * cross.tt),
        P.yy - (K.yx * cross.yx + K.yy * cross.yy + K.yt * cross.yt),
        P.yt - (K.yx * cross.tx + K.yy * cross.ty + K.yt * cross.tt),
        P.tt - (K.tx * cross.tx + K.ty * cross.ty + K.tt * cross.tt),
    )


def plus_square(P: Symmetric, d: Pose) -> Symmetric:
    """P + d d^T."""
    x, y, theta = d
    return Symmetric(
        *(P.xx + x * x, P.xy + x * y, P.xt + x * theta),
        *(P.yy + y * y, P.yt + y * theta, P.tt + theta * theta),
    )


def less_identity(K: Square) -> Square:
    """I - K."""
    return Square(1 - K.xx, -K.xy, -K.xt, -K.yx, 1 - K.yy, -K.yt, -K.tx, -K.ty, 1 - K.tt)
