"""Numbers of many robots: a row has one of each."""

from typing import NamedTuple

import numpy as np

from laglab_control.angle import wrapped
from laglab_control.model import Vector
from laglab_control.motion import Motion, Way

Row = Vector
"""(robots,)"""
Pose = Way[Row]
"""[m, m, rad] of each robot."""
Belief = Motion[Row]
"""A pose of each robot and its claimed covariance: a motion from the origin."""


class Speeds(NamedTuple):
    """v [m/s], omega [rad/s] of each robot."""

    v: Row
    omega: Row


def pose_of(belief: Belief) -> Pose:
    """Without the covariance."""
    return Way(belief.x, belief.y, belief.theta)


Heading = tuple[Row, Row]
"""Cosine and sine of an angle of each robot."""


def headings(angle: Row) -> Heading:
    """Of these angles [rad]."""
    return np.cos(angle), np.sin(angle)


def near_headings(angle: Row) -> Heading:
    """The same, but for the last bits: one tangent, of half the angle, is quicker than both."""
    t = np.tan(0.5 * angle)
    squared = t * t
    length = 1.0 + squared
    cosine = np.subtract(1.0, squared, squared)
    cosine /= length
    t += t
    t /= length
    return cosine, t


def difference(z: Pose, x: Pose) -> Pose:
    """z - x, its heading wrapped."""
    return Way(z.x - x.x, z.y - x.y, wrapped(z.theta - x.theta))
