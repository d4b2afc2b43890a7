"""What it is to be at the goal; the practical default comes to rest there, wherever it starts and
whatever the noise."""

import numpy as np
import pytest

import laglab
from laglab.results.numbers import at_goal, has_converged

SEEDS = 24


def ends_at_goal(seed):
    """One noisy run of `lab` from a random pose within 5 m; its last tick."""
    random = np.random.default_rng(seed)
    distance, bearing = 5 * np.sqrt(random.uniform()), random.uniform(-np.pi, np.pi)
    start = (distance * np.cos(bearing), distance * np.sin(bearing), random.uniform(-np.pi, np.pi))
    final = laglab.run("lab", {"start": start, "seed": seed}).summary.final
    return final.rho < 0.06 and abs(final.theta_error) < 0.05


@pytest.mark.slow
@pytest.mark.timeout(240)
def test_it_ends_at_the_goal_wherever_it_starts():
    assert all(map(ends_at_goal, range(SEEDS)))


@pytest.mark.parametrize(
    ("off", "there"),
    [
        ((0.0, -0.0599, 0.0499), True),
        ((0.036, 0.048, 0.0), False),  # 0.06 m
        ((0.0601, 0.0, 0.0), False),
        ((0.0, 0.0, -0.0501), False),
        ((0.0, 0.0, 0.0499 + 2 * np.pi), True),
    ],
)
def test_at_the_goal_is_nearer_than_6_cm_and_5_hundredths_of_a_radian(off, there):
    goal = np.array((1.0, -2.0, 0.5))
    assert at_goal(goal + off, goal) == there


@pytest.mark.parametrize(("away", "converged"), [(199, True), (200, False), (300, False)])
def test_who_was_away_at_a_tick_of_the_last_second_has_not_converged(away, converged):
    pose = np.zeros((301, 3))
    pose[away, 0] = 0.1
    trace = dict(zip(("x", "y", "theta"), pose.T, strict=True)) | {"time": np.arange(301) * 0.01}
    assert has_converged(trace, (0.0, 0.0, 0.0)) == converged
