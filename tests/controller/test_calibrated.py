"""The windows of `calibrating-ekf`: (27) step by step, and exact where a motion is linear in b."""

import numpy as np
import pytest

from laglab_control import CalibratingEkf, Measured, RobotModel, WheelScales
from laglab_control.estimators.calibrating.calibrated import CalibratedMotions, CalibratedRobot
from laglab_control.estimators.kalman import Belief

ROBOT = RobotModel(Q=np.array([[0.02, 0.003], [0.003, 0.005]]))
Ts, L = ROBOT.sample_time, ROBOT.track
SCALES = WheelScales(L)
B = [0.1, -0.05]
RANDOM = np.random.default_rng(6)
INPUTS = RANDOM.normal(size=(30, 2)) * [1.0, 3.0]
X = np.array([1.0, 2.0, 0.7, *B])
ROOT = RANDOM.normal(size=(5, 5)) * 0.1
P = ROOT @ ROOT.T


def step(x, covariance, u):
    """(27) of x and b by their definitions: A (31) at the speeds that the wheels really have."""
    left, right = u[0] - u[1] * L / 2, u[0] + u[1] * L / 2
    speeds = np.array(
        [
            ((1 + x[3]) * left + (1 + x[4]) * right) / 2,
            ((1 + x[4]) * right - (1 + x[3]) * left) / L,
        ]
    )
    by_speeds = Ts * np.array([[np.cos(x[2]), 0], [np.sin(x[2]), 0], [0, 1]])
    by_scales = np.array([[left / 2, right / 2], [-left / L, right / L]])
    F, Q, W = np.eye(5), np.zeros((5, 5)), ROBOT.W(x[:3])
    F[:3] = np.hstack((ROBOT.A(x[:3], speeds), by_speeds @ by_scales))
    Q[:3, :3] = W @ ROBOT.Q @ W.T
    return np.append(ROBOT.f(x[:3], speeds), x[3:]), F @ covariance @ F.T + Q, F


def composed(motions, parts):
    """Of all parts, in halves: which are put together first must make no difference."""
    if len(parts) < 2:
        return parts[0] if parts else motions.identity
    half = len(parts) // 3 + 1
    return motions.compose(composed(motions, parts[:half]), composed(motions, parts[half:]))


@pytest.mark.parametrize("ticks", [0, 1, 2, 30])
def test_a_window_is_its_ticks_one_after_the_other(ticks):
    motions = CalibratedMotions(ROBOT, SCALES, B)
    x, covariance = X, P
    for u in INPUTS[:ticks]:
        x, covariance, _ = step(x, covariance, u)
    window = composed(motions, [motions.over(u) for u in INPUTS[:ticks]])
    carried = motions.carry(Belief(X, P), window)
    np.testing.assert_allclose(carried.x, x[:3], rtol=0, atol=1e-13)
    np.testing.assert_allclose(carried.P, covariance[:3, :3], rtol=0, atol=1e-13)


def test_the_empty_window_changes_no_other():
    motions = CalibratedMotions(ROBOT, SCALES, B)
    some = motions.over(INPUTS[0])
    for both in (motions.compose(motions.identity, some), motions.compose(some, motions.identity)):
        assert both.motion == pytest.approx(some.motion)
        assert np.array(both.slopes) == pytest.approx(np.array(some.slopes))
        assert both.at == B


def test_windows_of_two_b_are_put_together_at_the_newer_one():
    """The motion of one tick is linear in b: so it is moved to the other b without an error."""
    other = [-0.2, 0.3]
    older, newer = CalibratedMotions(ROBOT, SCALES, other), CalibratedMotions(ROBOT, SCALES, B)
    u, then = INPUTS[:2]
    mixed = newer.compose(older.over(u), newer.over(then))
    pure = newer.compose(newer.over(u), newer.over(then))
    assert mixed.at is newer.at
    assert mixed.motion == pytest.approx(pure.motion, abs=1e-15)
    assert np.array(mixed.slopes) == pytest.approx(np.array(pure.slopes), abs=1e-15)
    carried, straight = (motions.carry(Belief(X, P), motions.over(u)) for motions in (older, newer))
    np.testing.assert_allclose(carried.x, straight.x, rtol=0, atol=2e-15)
    np.testing.assert_allclose(carried.P, straight.P, rtol=0, atol=2e-15)


def test_where_a_tick_leads_is_what_the_wheels_make_of_it():
    """L = 0.6, u = (1, 2): rims 0.4 and 1.6 m/s, really 0.44 and 1.52: v = 0.98, omega = 1.8."""
    way = CalibratedMotions(ROBOT, SCALES, B).way(np.array([1.0, 2.0]))
    assert way == pytest.approx((Ts * 0.98, 0.0, Ts * 1.8))


def test_a_tick_of_the_robot_and_its_derivative():
    """As `step`, and b walks by Ts wander^2 |rim| in a tick."""
    robot, u = CalibratedRobot(ROBOT, SCALES), np.array([1.0, -2.0])
    x, covariance, F = step(X, P, u)
    covariance[3, 3] += Ts * 0.03**2 * 1.6
    covariance[4, 4] += Ts * 0.03**2 * 0.4
    prior = robot.predict(X, P, u)
    np.testing.assert_allclose(prior[0], x, rtol=0, atol=2e-15)
    np.testing.assert_allclose(prior[1], covariance, rtol=0, atol=2e-15)
    np.testing.assert_allclose(robot.A(X, u), F, rtol=0, atol=2e-15)
    np.testing.assert_array_equal(robot.h(X), X[:3])
    np.testing.assert_array_equal(robot.H(X), np.eye(5)[:3])
    assert robot.measurement_noise(X) is ROBOT.R
    off = robot.innovation(X[:3] + np.array([0.1, 0.2, 2 * np.pi]), X[:3])
    np.testing.assert_allclose(off, [0.1, 0.2, 0.0], atol=1e-14)


def test_what_wheels_make_of_an_input():
    """The rims' speeds v -+ omega L/2 are 0.4 and 1.6 m/s; in half a wheel's way each."""
    v, omega, by = SCALES.taken(np.array([1.0, 2.0]), B)
    assert (v, omega) == pytest.approx((0.98, 1.8))
    assert np.array(by) == pytest.approx(np.array([[0.2, -0.4 / 0.6], [0.8, 1.6 / 0.6]]))
    assert SCALES.walk(np.array([1.0, 2.0])) == pytest.approx((0.03**2 * 0.4, 0.03**2 * 1.6))
    assert SCALES.deviations == (0.05, 0.05)
    assert SCALES.names == ("left wheel", "right wheel")


def corrected(estimator):
    """One measurement, of the second tick."""
    state = estimator.start(X[:3], P[:3, :3])
    for u in INPUTS[:2]:
        state = estimator.predict(state, u)
    z = state.x + np.array([0.5, -0.4, 0.3])
    return state, estimator.correct(state, [Measured(2, z)])


def test_it_begins_with_b_of_0_as_surely_as_told():
    estimator = CalibratingEkf(ROBOT, WheelScales(L, deviation=0.2))
    state = estimator.start(X[:3], P[:3, :3])
    np.testing.assert_array_equal(state.parameters.x, [0.0, 0.0])
    np.testing.assert_allclose(state.parameters.P, 0.04 * np.eye(2))
    np.testing.assert_array_equal(state.x, X[:3])
    np.testing.assert_allclose(state.P, P[:3, :3])
    assert estimator.innovation(state) is None


def test_its_windows_are_made_at_another_b_when_it_is_off_by_more_than_the_tolerance():
    begun, state = corrected(CalibratingEkf(ROBOT, SCALES, tolerance=np.inf))
    b = state.parameters.x.tolist()
    assert state.motions.at == begun.motions.at == [0.0, 0.0]
    furthest = max(map(abs, b))
    for tolerance, stays in ((furthest, True), (np.nextafter(furthest, 0), False)):
        begun, state = corrected(CalibratingEkf(ROBOT, SCALES, tolerance=tolerance))
        assert (state.motions is begun.motions) is stays
        assert state.motions.at == ([0.0, 0.0] if stays else b)
        assert state.joint.windows is state.motions
    assert CalibratingEkf(ROBOT, SCALES).tolerance == 0.01


def test_what_is_as_expected_leaves_its_windows_as_they_are():
    """Begun again at the b that was learned, which z = h(x^-) does not change."""
    _, state = corrected(CalibratingEkf(ROBOT, SCALES))
    learned = state.parameters.x.tolist()
    estimator = CalibratingEkf(ROBOT, SCALES, tolerance=max(map(abs, learned)))
    begun = estimator.restart(state, X[:3], P[:3, :3])
    assert begun.motions.at == learned
    assert estimator.correct(begun, [Measured(0, X[:3])]).motions is begun.motions


def test_what_was_learned_is_told_with_its_standard_deviation():
    estimator = CalibratingEkf(ROBOT, SCALES)
    _, state = corrected(estimator)
    x, covariance = state.parameters
    for i, told in enumerate(estimator.learned(state)):
        assert told.name == SCALES.names[i]
        assert told.value == x[i]
        assert told.deviation == pytest.approx(np.sqrt(covariance[i, i]))
    assert estimator.calibrated(state, ROBOT) is state.motions


def test_a_parameter_without_a_name_is_not_passed_over():
    class Nameless(WheelScales):
        names = ("left wheel",)

    estimator = CalibratingEkf(ROBOT, Nameless(L))
    with pytest.raises(ValueError, match="zip"):
        estimator.learned(estimator.start(X[:3], P[:3, :3]))
