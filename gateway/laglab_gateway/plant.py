"""What the gateway moves: anything that can be read and stepped one tick."""

from typing import Protocol

from laglab_fmu import Reading, Robot


class Plant(Protocol):
    """A differential-drive robot on its own sampling grid."""

    def read(self) -> Reading:
        """The pose now, and the sensor's sample of it [m, m, rad]."""

    def step(self, v: float, omega: float) -> None:
        """Drive one tick at ``v`` [m/s] and ``omega`` [rad/s]."""


class FmuPlant:
    """The robot FMU, commanded by body speeds instead of wheel speeds."""

    def __init__(self, robot: Robot, wheel_radius: float, track: float) -> None:
        self._robot = robot
        self._wheel_radius = wheel_radius
        self._half_track = track / 2

    def read(self) -> Reading:
        """The FMU's outputs at this tick."""
        return self._robot.read()

    def step(self, v: float, omega: float) -> None:
        """Equation (1) solved for the wheel speeds, then one tick of (3)."""
        omega_left = (v - omega * self._half_track) / self._wheel_radius
        omega_right = (v + omega * self._half_track) / self._wheel_radius
        self._robot.step(omega_left, omega_right)
