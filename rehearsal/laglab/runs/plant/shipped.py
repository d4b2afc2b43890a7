"""`robot`, the differential drive that ships, as the gateway's plant."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from laglab.runs.plant.placing import pose_asked, seed_of
from laglab.scenario import Scenario
from laglab_fmu import RobotParameters
from laglab_gateway import Reading

if TYPE_CHECKING:
    from laglab_fmu import Robot


def robot_parameters(scenario: Scenario) -> RobotParameters:
    """The robot that the FMU simulates."""
    plant = scenario.plant
    return RobotParameters(
        wheel_radius=plant.wheel_radius,
        track=plant.track,
        sample_time=scenario.sample_time,
        wheel_noise_variance=plant.wheel_noise_variance,
        measurement_variance=plant.measurement_variance,
        start=scenario.start,
        seed=scenario.seed,
        noise=scenario.noise,
        integration=plant.integration,
        wheel_speed_max=plant.wheel_speed_max,
        motor_time_constant=plant.motor_time_constant,
        wheel_radius_error=plant.wheel_radius_error,
        track_error=plant.track_error,
        wheel_slip=plant.wheel_slip,
    )


def wheel_speeds(v: float, omega: float, radius: float, half_track: float) -> tuple[float, float]:
    """(1), solved for the left and the right wheel [rad/s]."""
    return (v - omega * half_track) / radius, (v + omega * half_track) / radius


class FmuPlant:
    """The robot FMU, commanded by body speeds instead of wheel speeds."""

    def __init__(self, robot: Robot, parameters: RobotParameters) -> None:
        self._robot = robot
        self._parameters = parameters
        self._wheel_radius = parameters.wheel_radius
        self._half_track = parameters.track / 2
        self._placed = 0
        self._reading = Reading(*robot.read())

    def read(self) -> Reading:
        """The FMU's outputs at this tick."""
        return self._reading

    def step(self, v: float, omega: float) -> None:
        """Equation (1) solved for the wheel speeds, then one tick of (3)."""
        wheels = wheel_speeds(v, omega, self._wheel_radius, self._half_track)
        self._reading = Reading(*self._robot.step(*wheels))

    def place(self, x: float, y: float, theta: float) -> None:
        """Start the FMU again from there, with noise that it did not have before."""
        start = pose_asked((x, y, theta), self._parameters.start)
        self._placed += 1
        seed = seed_of(self._parameters.seed, self._placed)
        self._robot.reset(replace(self._parameters, start=start, seed=seed))
        self._reading = Reading(*self._robot.read())
