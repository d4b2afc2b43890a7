"""What the gateway moves: anything that can be read and stepped one tick."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from laglab_fmu import Reading, Robot, RobotParameters


class Plant(Protocol):
    """A differential-drive robot on its own sampling grid."""

    def read(self) -> Reading:
        """The pose now, and the sensor's sample of it [m, m, rad]."""

    def step(self, v: float, omega: float) -> None:
        """Drive one tick at ``v`` [m/s] and ``omega`` [rad/s]."""

    def place(self, x: float, y: float, theta: float) -> None:
        """Put it at a pose [m, m, rad], at rest; NaN stands for the start pose's."""


class FmuPlant:
    """The robot FMU, commanded by body speeds instead of wheel speeds."""

    def __init__(self, robot: Robot, parameters: RobotParameters) -> None:
        self._robot = robot
        self._parameters = parameters
        self._wheel_radius = parameters.wheel_radius
        self._half_track = parameters.track / 2
        self._reading = robot.read()

    def read(self) -> Reading:
        """The FMU's outputs at this tick."""
        return self._reading

    def step(self, v: float, omega: float) -> None:
        """Equation (1) solved for the wheel speeds, then one tick of (3)."""
        omega_left = (v - omega * self._half_track) / self._wheel_radius
        omega_right = (v + omega * self._half_track) / self._wheel_radius
        self._reading = self._robot.step(omega_left, omega_right)

    def place(self, x: float, y: float, theta: float) -> None:
        """Start the FMU again from there; its noise starts again too."""
        asked, start = (x, y, theta), self._parameters.start
        x, y, theta = (
            there if math.isnan(each) else each for each, there in zip(asked, start, strict=True)
        )
        self._robot.reset(replace(self._parameters, start=(x, y, theta)))
        self._reading = self._robot.read()
