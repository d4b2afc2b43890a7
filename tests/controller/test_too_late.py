"""Measurements that are older than an estimator remembers are not used, and that is said."""

import numpy as np
import pytest

from laglab_control import Measured
from laglab_control.estimators.family import ESTIMATORS
from laglab_control.robot import RobotModel

REMEMBERS = {name: kind.memory for name, kind in ESTIMATORS.items() if kind.memory is not None}


def uses(name: str, late: int) -> bool:
    """Whether a measurement so late changes the estimate."""
    estimator = ESTIMATORS[name].make(RobotModel())
    state = estimator.start(np.zeros(3), np.eye(3) * 1e-3)
    for _ in range(3000):
        state = estimator.predict(state, np.array([0.1, 0.1]))
    measured = Measured(state.tick - late, np.array([9.0, 9.0, 0.5]))
    return not np.array_equal(estimator.correct(state, [measured]).x, state.x)


@pytest.mark.parametrize(("name", "memory"), REMEMBERS.items())
def test_a_kinds_memory_is_how_late_a_measurement_may_come(name, memory):
    assert uses(name, memory)
    assert not uses(name, 2048 if name == "tue-predictor" else memory + 1)


@pytest.mark.parametrize("name", ["raw", "ekf"])
def test_who_takes_late_for_fresh_takes_any(name):
    assert ESTIMATORS[name].memory is None
    assert name == "raw" or uses(name, 2900)
