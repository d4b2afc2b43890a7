"""The fast forms against the literal ones over 10,000 ticks: nothing builds up."""

import numpy as np
import pytest

from laglab_control import (
    DelayedEkf,
    LiteralPopf,
    Popf,
    ReplayedInputs,
    RigidMotions,
    RobotModel,
    constant_delay,
    replay,
)

TICKS, M = 10_000, 20
ROBOT = RobotModel()
START, P_0 = np.array([-3.0, -3.0, 0.0]), np.eye(3) * 1e-4


@pytest.fixture(scope="module")
def drive():
    """A robot that turns about; its inputs (N, 2) and noisy measurements (N+1, 3)."""
    random = np.random.default_rng(8)
    inputs = random.normal(size=(TICKS, 2)) * [1.0, 2.0]
    poses = [START]
    for u in inputs:
        poses.append(ROBOT.f(poses[-1], u))
    return inputs, np.array(poses) + random.normal(size=(TICKS + 1, 3)) * [0.1, 0.1, 0.134]


@pytest.mark.parametrize(
    ("fast", "literal"),
    [
        (Popf(ROBOT), LiteralPopf(ROBOT)),
        (DelayedEkf(ROBOT, RigidMotions(ROBOT)), DelayedEkf(ROBOT, ReplayedInputs(ROBOT))),
    ],
    ids=["popf", "delayed-ekf"],
)
def test_nothing_builds_up(drive, fast, literal):
    inputs, measurements = drive
    one, other = (
        replay(estimator, START, P_0, inputs, constant_delay(measurements, M))
        for estimator in (fast, literal)
    )
    assert np.abs(one.estimates - other.estimates).max() < 1e-9
    assert np.abs(one.covariances - other.covariances).max() < 1e-9
