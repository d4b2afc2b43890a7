"""What limits the commands of every law, before they are sent: so the estimator knows it."""

import math
from dataclasses import dataclass

from laglab_control.laws.interface import Demand
from laglab_control.limits import Positive, check
from laglab_control.model import Matrix


@dataclass(frozen=True)
class SpeedLimits:
    """The limits; None switches each of them off, as in the paper.

    `v_max` [m/s] and `omega_max` [rad/s] clamp the speeds; `caution` [m] is the standard deviation
    of the estimated position above which the robot drives more slowly; `accel_max` [m/s^2] and
    `alpha_max` [rad/s^2] clamp how far a command may be from the last one. Raises ConfigError,
    naming the field, for a value that cannot be.
    """

    v_max: Positive | None = None
    omega_max: Positive | None = None
    caution: Positive | None = None
    accel_max: Positive | None = None
    alpha_max: Positive | None = None

    def __post_init__(self) -> None:
        check(self)

    def limited(
        self,
        asked: tuple[float, float, object],
        P: Matrix | None,
        last: Demand,
        sample_time: float,
    ) -> Demand:
        """What is sent after `last` instead of what was `asked`.

        `P` (3, 3) is the covariance that is claimed for the pose; None: nothing is.
        """
        v, omega, memory = asked
        v, omega = _clamp(v, self.v_max), _clamp(omega, self.omega_max)
        if self.caution is not None and P is not None:
            share = _share(P, self.caution)
            v, omega = share * v, share * omega
        if self.accel_max is not None:
            v = last.v + _clamp(v - last.v, self.accel_max * sample_time)
        if self.alpha_max is not None:
            omega = last.omega + _clamp(omega - last.omega, self.alpha_max * sample_time)
        return Demand(v, omega, memory)


def _share(P: Matrix, caution: float) -> float:
    """The share of the speeds that the claimed covariance makes advisable."""
    variance = max(float(P[0, 0]), float(P[1, 1]))
    return 1.0 if variance <= caution * caution else caution / math.sqrt(variance)


def _clamp(value: float, limit: float | None) -> float:
    return value if limit is None or not abs(value) > limit else math.copysign(limit, value)
