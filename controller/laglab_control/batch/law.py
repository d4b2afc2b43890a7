"""The control law (2), (4) for many robots."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.rows import Heading, Pose, Row, Speeds, headings, wrapped
from laglab_control.laws.aicardi import Law

# numpy's own differ from those of `Law` in the last bit. Where there is no noise a robot comes so
# near to its goal that the last bit decides where it looks.
_hypot, _atan2 = np.frompyfunc(math.hypot, 2, 1), np.frompyfunc(math.atan2, 2, 1)


def _polar_coordinates(dx: Row, dy: Row) -> tuple[Row, Row]:
    """Length and direction of each (dx, dy)."""
    return np.asarray(_hypot(dx, dy), np.float64), np.asarray(_atan2(dy, dx), np.float64)


class Demands(NamedTuple):
    """What the law answers, and which robots it holds at the goal."""

    speeds: Speeds
    at_goal: NDArray[np.bool_]


def stand_still(robots: int) -> Demands:
    """All of them."""
    return Demands(Speeds(np.zeros(robots), np.zeros(robots)), np.zeros(robots, np.bool_))


def drive(
    law: Law, pose: Pose, at_goal: NDArray[np.bool_], heading: Heading | None = None
) -> Demands:
    """`Law.drive`, to the last bit; given the poses' headings it is faster, to the last but one."""
    x, y, theta = pose
    x_goal, y_goal, theta_goal = law.goal
    offset = x_goal - x, y_goal - y
    if heading is None:
        rho, psi = _polar_coordinates(*offset)
        alpha, phi = wrapped(psi - theta), wrapped(psi - theta_goal)
        ahead = headings(alpha)
    else:
        rho, alpha, ahead = _seen(*offset, heading)
        phi = wrapped(alpha + (theta - theta_goal))
    speeds = _polar(law, rho, alpha, ahead, phi)
    if law.goal_tolerance is None:
        at_goal = np.zeros(len(rho), np.bool_)
    else:
        near, leaving = rho < law.goal_tolerance, rho <= 2 * law.goal_tolerance
        at_goal = near | (at_goal & leaving)
    if at_goal.any():
        turn = law.lambda_ / 2 * wrapped(theta_goal - theta)
        speeds = Speeds(np.where(at_goal, 0.0, speeds.v), np.where(at_goal, turn, speeds.omega))
    return Demands(_clamped(law, speeds), at_goal)


def slowed(law: Law, speeds: Speeds, P: Symmetric) -> Speeds:
    """`Law.slowed`."""
    if law.caution is None:
        return speeds
    variance = np.maximum(P.xx, P.yy)
    if not (variance > law.caution**2).any():
        return speeds
    share = np.where(variance > law.caution**2, law.caution / np.sqrt(variance), 1.0)
    return Speeds(share * speeds.v, share * speeds.omega)


def _seen(dx: Row, dy: Row, heading: Heading) -> tuple[Row, Row, Heading]:
    """Length and direction of each (dx, dy) as seen from the robot; cosine and sine of that."""
    c, s = heading
    along, across = dx * c, dy * c
    along += dy * s
    across -= dx * s
    rho = along * along
    rho += across * across
    np.sqrt(rho, rho)
    alpha = np.arctan2(across, along)
    along /= rho
    across /= rho
    return rho, alpha, (along, across)


def _polar(law: Law, rho: Row, alpha: Row, ahead: Heading, phi: Row) -> Speeds:
    """(4); `ahead`: cosine and sine of alpha."""
    cosine, sine = ahead
    forward = law.gamma * cosine
    sinc = sine / alpha
    straight = alpha == 0.0
    if straight.any():
        sinc[straight] = 1.0
    sinc *= forward
    sinc *= alpha + law.h * phi
    sinc += law.lambda_ * alpha
    forward *= rho
    return Speeds(forward, sinc)


def _clamped(law: Law, speeds: Speeds) -> Speeds:
    return Speeds(_clamp(speeds.v, law.v_max), _clamp(speeds.omega, law.omega_max))


def _clamp(value: Row, limit: float | None) -> Row:
    return value if limit is None else np.minimum(np.maximum(value, -limit), limit)
