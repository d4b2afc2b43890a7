"""The control law (2), (4) for many robots."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control.angle import wrapped
from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.rows import Heading, Pose, Row, Speeds, headings
from laglab_control.config import StationConfig
from laglab_control.errors import ConfigError
from laglab_control.laws import PolarLaw, SpeedLimits

# numpy's own differ from those of `PolarLaw` in the last bit. Where there is no noise a robot comes
# so near to its goal that the last bit decides where it looks.
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
    law: PolarLaw, pose: Pose, at_goal: NDArray[np.bool_], heading: Heading | None = None
) -> Demands:
    """`PolarLaw.drive`, to the last bit; faster, given the poses' headings, to the last but one."""
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
        np.putmask(speeds.v, at_goal, 0.0)
        np.putmask(speeds.omega, at_goal, turn)
    return Demands(speeds, at_goal)


def limited(
    limits: SpeedLimits, asked: Speeds, P: Symmetric | None, last: Speeds, sample_time: float
) -> Speeds:
    """`SpeedLimits.limited`."""
    v, omega = _clamp(asked.v, limits.v_max), _clamp(asked.omega, limits.omega_max)
    if P is not None and limits.caution is not None:
        variance = np.maximum(P.xx, P.yy)
        wide = variance > limits.caution * limits.caution
        if wide.any():
            share = np.where(wide, limits.caution / np.sqrt(variance), 1.0)
            v, omega = share * v, share * omega
    if limits.accel_max is not None:
        v = last.v + _clamp(v - last.v, limits.accel_max * sample_time)
    if limits.alpha_max is not None:
        omega = last.omega + _clamp(omega - last.omega, limits.alpha_max * sample_time)
    return Speeds(v, omega)


def polar_law(config: StationConfig) -> PolarLaw:
    """The station's law. Raises ConfigError for any but PolarLaw: many robots have no other."""
    if not isinstance(config.law, PolarLaw):
        raise ConfigError(f"there is no {type(config.law).__name__} for many robots, but PolarLaw")
    return config.law


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


def _polar(law: PolarLaw, rho: Row, alpha: Row, ahead: Heading, phi: Row) -> Speeds:
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


def _clamp(value: Row, limit: float | None) -> Row:
    return value if limit is None else np.minimum(np.maximum(value, -limit), limit)
