"""The practical default comes to rest at the goal, wherever it starts and whatever the noise."""

import numpy as np
import pytest

import laglab

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
