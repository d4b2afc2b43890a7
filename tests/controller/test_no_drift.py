"""The fast forms against the literal ones over 10,000 ticks: nothing builds up."""

import numpy as np
import pytest

from laglab_control import (
    DelayedEkf,
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


def literal_popf(inputs, measurements):
    """(27), (28), the product of (21) taken anew at every tick."""
    x, P, K = START, P_0, np.zeros((3, 3))
    priors, factors, estimates = [(x, P)], [], [x]
    for k, u in enumerate(inputs, start=1):
        A, W = ROBOT.A(x, u), ROBOT.W(x)
        factors.append(A @ (np.eye(3) - K))
        x, P = ROBOT.f(x, u), A @ P @ A.T + W @ ROBOT.Q @ W.T
        priors.append((x, P))
        if k >= M:
            x_s, P_s = priors[k - M]
            M_star = np.eye(3)
            for factor in reversed(factors[k - M :]):
                M_star = M_star @ factor
            K = M_star @ P_s @ np.linalg.inv(P_s + ROBOT.R)
            x = x + K @ ROBOT.innovation(measurements[k - M], x_s)
            P = P - K @ P_s @ M_star.T
            P = (P + P.T) / 2
        estimates.append(x)
    return np.array(estimates)


def test_popf(drive):
    inputs, measurements = drive
    fast = replay(Popf(ROBOT), START, P_0, inputs, constant_delay(measurements, M))
    assert np.abs(fast.estimates - literal_popf(inputs, measurements)).max() < 1e-9


def test_delayed_ekf(drive):
    inputs, measurements = drive
    fast, literal = (
        replay(DelayedEkf(ROBOT, windows), START, P_0, inputs, constant_delay(measurements, M))
        for windows in (RigidMotions(ROBOT), ReplayedInputs(ROBOT))
    )
    assert np.abs(fast.estimates - literal.estimates).max() < 1e-9
    assert np.abs(fast.covariances - literal.covariances).max() < 1e-9
