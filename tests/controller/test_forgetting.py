"""How late is too late: the last tick that each estimator still takes, and the one before it."""

import numpy as np
import pytest

from laglab_control import (
    CalibratingEkf,
    DelayedEkf,
    Ekf,
    InForce,
    Measured,
    Popf,
    PopfExact,
    ReplayedInputs,
    RigidMotions,
    RobotModel,
    TuePredictor,
    WheelScales,
)
from laglab_control.estimators.delayed.rewinding import Rewinding
from laglab_control.past.memory import MEMORY

ROBOT = RobotModel()
X, P = np.array([1.0, 2.0, 0.5]), np.diag([0.1, 0.2, 0.3])
U, Z = np.array([0.4, -0.3]), np.array([2.0, 1.0, 0.0])
KEPT = 4


def after(estimator, ticks, z=None):
    """Driven by U; z measured and told at the last tick, if given."""
    state = estimator.start(X, P)
    for _ in range(ticks):
        state = estimator.predict(state, U)
    return state if z is None else estimator.correct(state, [Measured(ticks, z)])


def differs(one, other):
    return bool(np.any(one.x != other.x))


@pytest.mark.parametrize("name", [Popf, PopfExact])
def test_popf_takes_what_is_less_than_its_memory_late_and_that_once(name):
    popf = name(ROBOT, memory=KEPT)
    state = after(popf, 10)
    assert popf.correct(state, [Measured(10 - KEPT, Z)]) is state
    taken = popf.correct(state, [Measured(11 - KEPT, Z)])
    assert differs(taken, state)
    assert popf.correct(taken, [Measured(11 - KEPT, Z)]) is taken
    later = popf.predict(taken, U)
    assert popf.correct(later, [Measured(11 - KEPT, Z)]) is later


def test_what_they_keep_if_nothing_else_is_said():
    assert PopfExact(ROBOT).memory == 512
    assert MEMORY == 1024
    for estimator in (Popf(ROBOT), Rewinding(Ekf(ROBOT)), DelayedEkf(ROBOT, RigidMotions(ROBOT))):
        assert estimator.memory == MEMORY


def test_popf_prepares_for_nothing_that_it_does_not_take():
    popf = Popf(ROBOT, memory=KEPT)
    state = after(popf, 3)
    for s in (-1, 4):
        assert popf.expect(state, s) is state
    for s in (0, 3):
        assert popf.expect(state, s).expected.s == s
    late = after(popf, 10)
    assert popf.expect(late, 10 - KEPT) is late
    assert popf.expect(late, 11 - KEPT).expected.s == 11 - KEPT


def test_popf_keeps_no_more_than_it_needs():
    """However long it runs: a bit for each tick of its memory."""
    popf = Popf(ROBOT, memory=KEPT)
    state = after(popf, 0)
    for k in range(1, 30):
        state = popf.correct(popf.predict(state, U), [Measured(k, X)])
        assert state.used.ticks == 2 ** min(k, KEPT) - 1
        assert sum(1 for _ in state.used.past.backwards()) <= 2 * KEPT


def ekfs():
    return [
        DelayedEkf(ROBOT, RigidMotions(ROBOT), KEPT),
        DelayedEkf(ROBOT, ReplayedInputs(ROBOT), KEPT),
        CalibratingEkf(ROBOT, WheelScales(ROBOT.track), KEPT),
    ]


@pytest.mark.parametrize("estimator", ekfs())
def test_delayed_ekf_takes_what_is_up_to_its_memory_older_than_the_newest(estimator):
    """The input of tick j led to j + 1: that of the oldest tick is the first that counts."""
    state = after(estimator, 10, z=Z)
    oldest = 10 - KEPT
    assert differs(estimator.correct(state, [Measured(oldest, Z)]), state)
    assert not differs(estimator.correct(state, [Measured(oldest - 1, Z)]), state)
    assert estimator.innovation(estimator.correct(state, [Measured(oldest, Z)])) is not None
    assert differs(estimator.correct(state, [], [InForce(oldest, 2 * U)]), state)
    assert not differs(estimator.correct(state, [], [InForce(oldest - 1, 2 * U)]), state)


@pytest.mark.parametrize("estimator", ekfs())
def test_delayed_ekf_goes_on_by_itself_when_nothing_comes(estimator):
    """It is at tick 10 - 4 then, and its memory begins 4 ticks before."""
    state = after(estimator, 10)
    oldest = 10 - 2 * KEPT
    assert differs(estimator.correct(state, [Measured(oldest, Z)]), state)
    assert not differs(estimator.correct(state, [Measured(oldest - 1, Z)]), state)


def test_what_is_in_force_from_now_on_is_told_by_predict():
    for estimator in (*ekfs(), Rewinding(Ekf(ROBOT))):
        state = after(estimator, 3)
        told = estimator.correct(state, [], [InForce(3, 2 * U)])
        assert not differs(told, state)
        assert not differs(estimator.predict(told, U), estimator.predict(state, U))


def test_rewinding_puts_the_inputs_of_its_memory_right():
    """After ten ticks the log of at most 2 * 4 was cut to 4 once, and holds ticks 4 to 9."""
    rewinding = Rewinding(Ekf(ROBOT), KEPT)
    state = after(rewinding, 10)
    for j in (-1, 0, 3):
        assert not differs(rewinding.correct(state, [], [InForce(j, 2 * U)]), state)
    for j in (4, 10 - KEPT, 9):
        right = rewinding.correct(state, [], [InForce(j, 2 * U)])
        x = X
        for k in range(10):
            x = ROBOT.f(x, 2 * U if k == j else U)
        np.testing.assert_allclose(right.x, x, rtol=0, atol=1e-14)


def test_tue_predictor_takes_what_it_has_a_pose_of():
    """It began with that of tick 0, and keeps at least as many as MEMORY."""
    predictor = TuePredictor(ROBOT)
    state = after(predictor, MEMORY)
    assert differs(predictor.correct(state, [Measured(0, Z)]), state)
    assert differs(predictor.correct(state, [Measured(1, Z)]), state)
