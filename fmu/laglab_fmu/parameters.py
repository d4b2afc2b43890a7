"""What a robot is told before it starts, and what it says at every tick."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import ClassVar, NamedTuple, Protocol

INTEGRATIONS = (
    ("euler", "One Euler step per sample, equation (3)"),
    ("exact", "Along the arc"),
)
"""How co-simulation moves the robot, and what that means; the FMU counts them from 1."""
LARGEST_SEED = 2**31 - 1


class ShippedParameters(Protocol):
    """Of one robot of any model that ships."""

    @property
    def model(self) -> str:
        """The name of its FMUs, without the version of FMI."""

    @property
    def sample_time(self) -> float:
        """[s]."""

    def by_name(self) -> Mapping[str, float]:
        """All of them by the FMU's names. Raises ValueError, CallError: one cannot be."""


@dataclass(frozen=True)
class RobotParameters:
    """Parameters of one robot, SI units. By default the paper's, with every realism option off.

    The defaults stand here alone: the model descriptions take their start values from them.
    """

    model: ClassVar[str] = "Robot"
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

    def by_name(self) -> dict[str, float]:
        """The parameters by the FMU's names, as numbers.

        Raises:
            ValueError: `integration` is unknown, `seed` out of range, or a tuple not of three.
        """
        if not 0 <= self.seed <= LARGEST_SEED:
            raise ValueError(f"seed is {self.seed}; it must be in 0 ... 2^31 - 1")
        numbers = {field.name: getattr(self, field.name) for field in fields(self)}
        variances, start = numbers.pop("measurement_variance"), numbers.pop("start")
        axes = ("x", "y", "theta")
        numbers |= {f"measurement_variance_{a}": R for a, R in zip(axes, variances, strict=True)}
        numbers |= {f"{axis}_start": value for axis, value in zip(axes, start, strict=True)}
        return numbers | {"noise": int(self.noise), "integration": self._integration_number()}

    def _integration_number(self) -> int:
        names = [name for name, _ in INTEGRATIONS]
        if self.integration not in names:
            known = ", ".join(names)
            raise ValueError(f"integration is {self.integration!r}; it must be one of {known}")
        return names.index(self.integration) + 1


def values(rows: Sequence[Mapping[str, float]], names: Sequence[str]) -> list[float]:
    """All robots' values (`by_name`) of the first name, then of the next: the order of FMI 3.0
    arrays."""
    return [row[name] for name in names for row in rows]


class Reading(NamedTuple):
    """What the FMU gives at a tick: pose and last sample's measurement [m, m, rad],
    body speeds [m/s, rad/s]."""

    x: float
    y: float
    theta: float
    x_meas: float
    y_meas: float
    theta_meas: float
    v: float
    omega: float
