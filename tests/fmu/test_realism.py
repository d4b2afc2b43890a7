"""What makes a robot real, each by itself; all of it is off by default."""

import math
from typing import Any

import pytest

from laglab_fmu import Reading, Robot, RobotParameters

RADIUS, TRACK, Ts = 0.05, 0.6, 0.01


def steps(ticks: int, left: float, right: float, **realism: Any) -> list[Reading]:
    with Robot.open(3, RobotParameters(noise=False, **realism)) as robot:
        return [robot.step(left, right) for _ in range(ticks)]


def test_off_by_default() -> None:
    parameters = RobotParameters()
    assert parameters.wheel_speed_max == 0
    assert parameters.motor_time_constant == 0
    assert parameters.wheel_radius_error == 0
    assert parameters.track_error == 0
    assert parameters.wheel_slip == 0


def test_wheel_drives_reach_their_limit_only() -> None:
    [reading] = steps(1, -30.0, 20.0, wheel_speed_max=12.0)
    assert reading.v == 0.0
    assert reading.omega == pytest.approx(RADIUS * 24 / TRACK)
    assert steps(1, 5.0, 5.0, wheel_speed_max=12.0) == steps(1, 5.0, 5.0)


def test_wheel_drives_lag_behind_their_command() -> None:
    readings = steps(50, 10.0, 10.0, motor_time_constant=0.1)
    for tick, reading in enumerate(readings, start=1):
        # after `tick` samples the drive has had one more of its lag in force
        reached = 10.0 * (1 - math.exp(-(tick + 1) * Ts / 0.1))
        assert reading.v == pytest.approx(RADIUS * reached, rel=1e-12)
    faster = steps(50, 10.0, 10.0, motor_time_constant=1e-6)
    assert faster[-1].x == pytest.approx(steps(50, 10.0, 10.0)[-1].x, rel=1e-12)


@pytest.mark.parametrize(
    ("realism", "v_factor", "omega_factor"),
    [
        ({"wheel_radius_error": 0.02}, 1.02, 1.02),
        ({"track_error": 0.1}, 1.0, 1 / 1.1),
        ({"wheel_slip": 0.05}, 0.95, 0.95),
    ],
)
def test_geometry_and_slip(realism: dict[str, float], v_factor: float, omega_factor: float) -> None:
    [real], [ideal] = steps(1, 3.0, 5.0, **realism), steps(1, 3.0, 5.0)
    assert real.v == pytest.approx(v_factor * ideal.v, rel=1e-14)
    assert real.omega == pytest.approx(omega_factor * ideal.omega, rel=1e-14)


def test_wheel_noise_comes_after_the_drive() -> None:
    """A drive at rest behind a slow motor still shakes."""
    parameters = RobotParameters(motor_time_constant=10.0, wheel_noise_variance=1.0)
    with Robot.open(3, parameters) as robot:
        assert abs(robot.step(0.0, 0.0).v) > 1e-3
