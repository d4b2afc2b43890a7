"""What a robot is told before it starts, and what it says at every tick."""

from dataclasses import dataclass
from typing import NamedTuple

from laglab_fmu.variables import INTEGRATIONS


@dataclass(frozen=True)
class RobotParameters:
    """Parameters of one robot, SI units. By default the paper's, with every realism option off."""

    wheel_radius: float = 0.05
    track: float = 0.6
    sample_time: float = 0.01
    wheel_noise_variance: float = 0.01
    """Q = wheel_noise_variance I_2, (rad/s)^2."""
    measurement_variance: tuple[float, float, float] = (0.01, 0.01, 0.018)
    """Diagonal of R: m^2, m^2, rad^2."""
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """x [m], y [m], theta [rad]."""
    seed: int = 1
    """0 ... 2^31 - 1."""
    noise: bool = True
    """False: every variance acts as zero."""
    integration: str = "euler"
    """`euler`, equation (3), or `exact`, along the arc."""
    wheel_speed_max: float = 0.0
    """Limit of each wheel drive, rad/s; 0 for none."""
    motor_time_constant: float = 0.0
    """First-order lag of the wheel drives, s; 0 for none."""
    wheel_radius_error: float = 0.0
    """True wheel radius over `wheel_radius`, less 1."""
    track_error: float = 0.0
    """True track over `track`, less 1."""
    wheel_slip: float = 0.0
    """Part of the wheels' motion lost to slip, 0 ... 1."""

    def floats(self) -> dict[str, float]:
        """The real-valued parameters, by the FMU's names."""
        axes = ("x", "y", "theta")
        return {
            "wheel_radius": self.wheel_radius,
            "track": self.track,
            "sample_time": self.sample_time,
            "wheel_noise_variance": self.wheel_noise_variance,
            **{
                f"measurement_variance_{axis}": value
                for axis, value in zip(axes, self.measurement_variance, strict=True)
            },
            **{f"{axis}_start": value for axis, value in zip(axes, self.start, strict=True)},
            "wheel_speed_max": self.wheel_speed_max,
            "motor_time_constant": self.motor_time_constant,
            "wheel_radius_error": self.wheel_radius_error,
            "track_error": self.track_error,
            "wheel_slip": self.wheel_slip,
        }

    def integration_number(self) -> int:
        """The FMU's number for `integration`.

        Raises:
            ValueError: no such integration.
        """
        names = [name for name, _ in INTEGRATIONS]
        if self.integration not in names:
            raise ValueError(
                f"integration is {self.integration!r}; it must be one of {', '.join(names)}"
            )
        return names.index(self.integration) + 1


class Reading(NamedTuple):
    """What the FMU gives at a tick: pose, last sample's measurement, body speeds; m, rad, s."""

    x: float
    y: float
    theta: float
    x_meas: float
    y_meas: float
    theta_meas: float
    v: float
    omega: float
