"""The commands that many robots are sent, driven one after the other from the origin.

What any stretch of them leads to is the difference of two places on that way, as if an odometer had
been read twice: it costs no more over many ticks than over one. By rounding it differs in the last
bits from the product of the motions of those ticks.
"""

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch.matrices import Symmetric, covariance_of, led
from laglab_control.batch.rows import Belief, Heading, Pose, Row, Speeds, near_headings
from laglab_control.motion import Motion, Way
from laglab_control.robot import RobotModel


class Leg(NamedTuple):
    """A command, in force for a tick."""

    u: Speeds
    before: Heading
    """Where the robot looks as it sets out."""
    end: Pose
    heading: Heading
    """At the end."""


def at_origin(robots: int) -> Leg:
    """Before the first command."""
    zeros, ones = np.zeros(robots), np.ones(robots)
    ahead = ones, zeros
    return Leg(Speeds(zeros, zeros), ahead, Way(zeros, zeros, zeros), ahead)


def driven(model: RobotModel, last: Leg, u: Speeds) -> Leg:
    """(3) from the end of the last leg on."""
    (x, y, theta), (c, s), Ts = last.end, last.heading, model.sample_time
    along = Ts * u.v
    across = s * along
    along *= c
    along += x
    across += y
    end = Way(along, across, theta + Ts * u.omega)
    return Leg(u, last.heading, end, near_headings(end.theta))


class Rotation(NamedTuple):
    """By how much a robot looks elsewhere than its odometer says: cosine and sine."""

    c: Row
    s: Row

    @classmethod
    def between(cls, leg: Leg, theta: Row) -> Self:
        """At the end of that leg."""
        return cls(*near_headings(theta - leg.end.theta))

    def of(self, heading: Heading) -> Heading:
        """Where the robot looks when its odometer says `heading`."""
        (c, s), (cosine, sine) = self, heading
        new_cosine, new_sine = c * cosine, s * cosine
        new_cosine -= s * sine
        new_sine += c * sine
        return new_cosine, new_sine

    def way(self, first: Leg, last: Leg) -> Pose:
        """From the end of the one leg to the end of the other, as seen from where the robot is."""
        (c, s), a, b = self, first.end, last.end
        dx, dy = b.x - a.x, b.y - a.y
        x, y = c * dx, s * dx
        x -= s * dy
        y += c * dy
        return Way(x, y, b.theta - a.theta)


Spread = NDArray[np.float64]
"""(7, robots): sums over the legs of a stretch, of which the covariance of its end is made: of
cos^2 and cos sin of the heading in which each sets out, times the noise along it; of x, y, xx, xy
and yy of where each ends, times the noise of its turn."""


def spread(model: RobotModel, leg: Leg) -> Spread:
    """Of one leg."""
    n_xx, _, _, _, _, n_tt = model.noise
    (c, s), (x, y, _) = leg.before, leg.end
    sums = np.empty((7, len(x)))
    along, sums_x, sums_y = n_xx * c, sums[2], sums[3]
    np.multiply(n_tt, x, sums_x)
    np.multiply(n_tt, y, sums_y)
    products = (along, c), (along, s), (sums_x, x), (sums_x, y), (sums_y, y)
    for row, (a, b) in zip((0, 1, 4, 5, 6), products, strict=True):
        np.multiply(a, b, sums[row])
    return sums


def uncertain(model: RobotModel, sums: Spread, legs: int, end: Pose) -> Symmetric:
    """P of a stretch that ends there, in the odometer's frame: the sum of J T N T^T J^T
    (`compose`) over its legs, N being the noise of one, and J what it does on the way from the
    leg's end (x_j, y_j): [1 0 y_j - y; 0 1 x - x_j; 0 0 1]."""
    n_xx, _, _, _, _, n_tt = model.noise
    cc, cs, x, y, xx, xy, yy = sums
    turned = legs * n_tt
    dx, dy = turned * end.x, turned * end.y
    dx -= x
    dy -= y
    P_xx, P_xy, P_yy = end.y * (dy - y), end.y * x, end.x * (dx - x)
    P_xx += yy
    P_xx += cc
    P_xy -= end.x * dy
    P_xy -= xy
    P_xy += cs
    P_yy += xx
    P_yy -= cc
    P_yy += legs * n_xx
    return Symmetric(P_xx, P_xy, np.negative(dy, dy), P_yy, dx, np.array([turned]))


def carried(belief: Belief, turn: Rotation, way: Pose, P: Symmetric) -> Belief:
    """`compose` of a belief and a stretch: its way as the robot has it, its P as the odometer."""
    dx, dy, turned = way
    xx, xy, xt, yy, yt, tt = led(covariance_of(belief), dx, dy)
    further = _rotated(P, turn)
    for each, more in zip((xx, xy, xt, yy, yt), further[:5], strict=True):
        each += more
    x, y, theta = belief.x + dx, belief.y + dy, belief.theta + turned
    return Motion(x, y, theta, xx, xy, xt, yy, yt, tt + further.tt)


def _rotated(P: Symmetric, turn: Rotation) -> Symmetric:
    """In arrays of its own."""
    (c, s), (xx, xy, xt, yy, yt, tt) = turn, P
    difference, cs = xx - yy, c * s
    moved = c * c
    moved *= difference
    cross = cs * xy
    cross *= 2
    moved -= cross
    cs *= difference
    twice = s * s
    twice *= -2
    twice += 1
    twice *= xy
    cs += twice
    c_xt, c_yt = c * xt, c * yt
    c_xt -= s * yt
    c_yt += s * xt
    return Symmetric(yy + moved, cs, c_xt, xx - moved, c_yt, tt)
