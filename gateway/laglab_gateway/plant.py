"""A plant, by what it does; where it comes from is nothing to the gateway."""

from typing import NamedTuple, Protocol


class Reading(NamedTuple):
    """The robot at a tick: its pose, the sensor's sample of it [m, m, rad], its body speeds
    [m/s, rad/s]."""

    x: float
    y: float
    theta: float
    x_meas: float
    y_meas: float
    theta_meas: float
    v: float
    omega: float


class Plant(Protocol):
    """A robot on its own sampling grid."""

    def read(self) -> Reading:
        """The robot at this tick."""

    def step(self, v: float, omega: float) -> None:
        """Drive one tick at ``v`` [m/s] and ``omega`` [rad/s]."""

    def place(self, x: float, y: float, theta: float) -> None:
        """Put it at a pose [m, m, rad], at rest; NaN stands for the start pose's coordinate."""
