"""The control law (2), (4) of Aicardi, with a goal tolerance."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from laglab_control.angle import wrap
from laglab_control.laws.interface import Demand
from laglab_control.limits import Positive, check, finite_pose


@dataclass(frozen=True)
class PolarLaw:
    """Drives the robot to `goal` [m, m, rad]. Gains: `lambda_` and `gamma` [1/s], `h`.

    `goal_tolerance` [m] is the distance inside which the robot only turns; None: there is none, as
    in the paper. Raises ConfigError, naming the field, for a value that cannot be.
    """

    goal: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lambda_: Positive = 6.0
    h: Positive = 1.0
    gamma: Positive = 3.0
    goal_tolerance: Positive | None = None

    def __post_init__(self) -> None:
        check(self)
        finite_pose(self.goal, "goal")

    def drive(self, pose: Iterable[float], time: float, memory: object) -> Demand:
        """The command at a finite `pose` (3,), at any time. Its memory: whether it holds the robot
        at the goal."""
        x, y, theta = pose
        x_goal, y_goal, theta_goal = self.goal
        rho = math.hypot(x_goal - x, y_goal - y)
        if self._holds(rho, at_goal=bool(memory)):
            return Demand(0.0, self.lambda_ / 2 * wrap(theta_goal - theta), True)
        psi = math.atan2(y_goal - y, x_goal - x)
        v, omega = self._polar(rho, alpha=wrap(psi - theta), phi=wrap(psi - theta_goal))
        return Demand(v, omega, False)

    def _holds(self, rho: float, at_goal: bool) -> bool:
        """Entered below the tolerance, left only above twice the tolerance."""
        if self.goal_tolerance is None:
            return False
        return rho <= 2 * self.goal_tolerance if at_goal else rho < self.goal_tolerance

    def _polar(self, rho: float, alpha: float, phi: float) -> tuple[float, float]:
        """v and omega by (4), the same as (2)."""
        v = self.gamma * math.cos(alpha) * rho
        sinc = math.sin(alpha) / alpha if alpha else 1.0
        omega = self.lambda_ * alpha + self.gamma * math.cos(alpha) * sinc * (alpha + self.h * phi)
        return v, omega
