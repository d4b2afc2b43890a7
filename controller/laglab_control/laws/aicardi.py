"""The control law (2), (4) of Aicardi, with limits and a goal tolerance."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from laglab_control.angle import wrap
from laglab_control.limits import Positive, check, finite_pose
from laglab_control.model import Matrix, Vector


class Demand(NamedTuple):
    """What the law answers: v [m/s], omega [rad/s], and whether it holds the robot at the goal."""

    v: float
    omega: float
    at_goal: bool


STAND_STILL = Demand(0.0, 0.0, at_goal=False)


@dataclass(frozen=True)
class Law:
    """Drives a pose [m, m, rad] to `goal`.

    `v_max` [m/s] and `omega_max` [rad/s] clamp the answer; `goal_tolerance` [m] is the distance
    inside which the robot only turns; `caution` [m] is the standard deviation of the estimated
    position above which it drives the more slowly. None switches each of them off, as in the paper.
    Raises ConfigError, naming the field, when one cannot be.
    """

    goal: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lambda_: Positive = 6.0
    h: Positive = 1.0
    gamma: Positive = 3.0
    v_max: Positive | None = None
    omega_max: Positive | None = None
    goal_tolerance: Positive | None = None
    caution: Positive | None = None

    def __post_init__(self) -> None:
        check(self)
        finite_pose(self.goal, "goal")

    def drive(self, pose: Iterable[float], at_goal: bool) -> Demand:
        """The command at a finite `pose` (3,). `at_goal` is the last answer's, False at first."""
        x, y, theta = pose
        x_goal, y_goal, theta_goal = self.goal
        rho = math.hypot(x_goal - x, y_goal - y)
        if self._holds(rho, at_goal):
            v, omega, at_goal = 0.0, self.lambda_ / 2 * wrap(theta_goal - theta), True
        else:
            psi = math.atan2(y_goal - y, x_goal - x)
            v, omega = self._polar(rho, alpha=wrap(psi - theta), phi=wrap(psi - theta_goal))
            at_goal = False
        return Demand(_clamp(v, self.v_max), _clamp(omega, self.omega_max), at_goal)

    def slowed(self, demand: Demand, P: Matrix) -> Demand:
        """As slow as the claimed covariance P (3, 3) of the pose makes advisable."""
        if self.caution is None:
            return demand
        variance = max(float(P[0, 0]), float(P[1, 1]))
        if variance <= self.caution**2:
            return demand
        share = self.caution / math.sqrt(variance)
        return Demand(share * demand.v, share * demand.omega, demand.at_goal)

    def _holds(self, rho: float, at_goal: bool) -> bool:
        """Entered below the tolerance, left only above twice the tolerance."""
        if self.goal_tolerance is None:
            return False
        return rho <= 2 * self.goal_tolerance if at_goal else rho < self.goal_tolerance

    def _polar(self, rho: float, alpha: float, phi: float) -> tuple[float, float]:
        """(4), the same as (2)."""
        v = self.gamma * math.cos(alpha) * rho
        sinc = math.sin(alpha) / alpha if alpha else 1.0
        omega = self.lambda_ * alpha + self.gamma * math.cos(alpha) * sinc * (alpha + self.h * phi)
        return v, omega


def _clamp(value: float, limit: float | None) -> float:
    return value if limit is None else min(max(value, -limit), limit)


def as_input(drive: Demand) -> Vector:
    """The command as the model's input u = [v, omega]."""
    return np.array((drive.v, drive.omega))
