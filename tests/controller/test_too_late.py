"""Measurements that are older than an estimator remembers are not used, and that is said."""

import numpy as np
import pytest

from laglab_control import Measured
from laglab_control.estimators.family import ESTIMATORS
from laglab_control.robot import RobotModel

MOST = {name: kind.most_late for name, kind in ESTIMATORS.items() if kind.most_late is not None}


def uses(name: str, late: int) -> bool:
    """Whether a measurement so late changes the estimate."""
    estimator = ESTIMATORS[name].make(RobotModel())
    state = estimator.start(np.zeros(3), np.eye(3) * 1e-3)
    for _ in range(3000):
        state = estimator.predict(state, np.array([0.1, 0.1]))
    measured = Measured(state.tick - late, np.array([9.0, 9.0, 0.5]))
    return not np.array_equal(estimator.correct(state, [measured]).x, state.x)


@pytest.mark.parametrize(("name", "most"), MOST.items())
def test_a_kind_tells_how_late_a_measurement_may_come(name, most):
    assert uses(name, most)
    assert not uses(name, 2048 if name == "tue-predictor" else most + 1)


@pytest.mark.parametrize("name", ["raw", "ekf"])
def test_who_takes_late_for_fresh_takes_any(name):
    assert ESTIMATORS[name].most_late is None
    assert name == "raw" or uses(name, 2900)
