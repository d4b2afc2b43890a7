"""Inputs that were believed wrong, and told right later: as if they had been known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_control import ESTIMATORS, Ekf, InForce, Measured, RobotModel
from laglab_control.estimators.delayed.rewinding import Rewinding

ROBOT = RobotModel()
TICKS, M = 40, 6
RANDOM = np.random.default_rng(4)
INPUTS = RANDOM.normal(size=(TICKS, 2))
BELIEVED = RANDOM.normal(size=(TICKS, 2))
MEASUREMENTS = RANDOM.normal(size=(TICKS + 1, 3)) * 0.1
NAMES = ["ekf", "popf", "popf-exact", "delayed-ekf"]


def run(estimator, believed, told):
    """`told[k]` lists the ticks whose right input is told at tick k."""
    state = estimator.start(np.zeros(3), np.eye(3) * 1e-2)
    for k in range(TICKS + 1):
        state = estimator.predict(state, believed[k - 1]) if k else state
        arrived = [Measured(k - M, MEASUREMENTS[k - M])] if k >= M else []
        state = estimator.correct(state, arrived, [InForce(j, INPUTS[j]) for j in told.get(k, ())])
    return state


def same(a, b):
    assert np.abs(a.x - b.x).max() < 1e-10
    assert np.abs(a.P - b.P).max() < 1e-10


@settings(max_examples=25)
@given(st.data(), st.sampled_from(NAMES))
def test_told_in_any_order_however_often(data, name):
    told = {}
    for j in range(TICKS):
        for k in data.draw(st.lists(st.integers(j + 1, TICKS), min_size=1, max_size=2)):
            told.setdefault(k, []).append(j)
    estimator = ESTIMATORS[name].make(ROBOT)
    same(run(estimator, BELIEVED, told), run(estimator, INPUTS, {}))


@pytest.mark.parametrize("name", NAMES)
def test_what_was_right_is_not_run_again(name):
    """Told what it knew, it is the same to the last bit."""
    estimator = ESTIMATORS[name].make(ROBOT)
    told = {k: [max(k - M - 1, 0)] for k in range(1, TICKS + 1)}
    a, b = run(estimator, INPUTS, told), run(estimator, INPUTS, {})
    np.testing.assert_array_equal(a.x, b.x)
    np.testing.assert_array_equal(a.P, b.P)


@pytest.mark.parametrize("wrong", [0, 12, TICKS - 1])
def test_it_runs_again_from_the_first_wrong_input_on_and_no_more(wrong):
    again = []

    class Telling(Ekf):
        def predict(self, state, u):
            again.append(state.tick)
            return super().predict(state, u)

    estimator = Rewinding(Telling(ROBOT))
    state = run(estimator, INPUTS, {})
    again.clear()
    estimator.correct(state, [], [InForce(j, INPUTS[j] + (j == wrong)) for j in range(TICKS)])
    assert again == list(range(wrong, TICKS))
