"""The robot as a model: its Jacobians beside differences, its innovation, and (27)."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from laglab_control import RobotModel, wrap, wrapped

coordinate = st.floats(-100, 100)
poses = st.tuples(coordinate, coordinate, coordinate).map(np.array)
inputs = st.tuples(st.floats(-20, 20), st.floats(-20, 20)).map(np.array)
robot = RobotModel()


def slope(function, at):
    """Central differences of a function at a vector, one column per component."""
    step = 1e-6
    columns = [(function(at + d) - function(at - d)) / (2 * step) for d in step * np.eye(len(at))]
    return np.stack(columns, axis=1)


@given(st.lists(st.floats(-1e4, 1e4), min_size=1))
def test_many_angles_are_wrapped_as_one_is(angles):
    together = wrapped(np.array([*angles, np.pi, -np.pi, np.inf, np.nan]))
    one_by_one = np.array([*map(wrap, angles), np.pi, np.pi, np.nan, np.nan])
    apart = np.abs(together - one_by_one)
    assert np.all(np.isclose(apart, 0, atol=1e-9) | np.isclose(apart, 2 * np.pi) | np.isnan(apart))
    assert np.array_equal(np.isnan(together), np.isnan(one_by_one))
    assert np.all(np.abs(together[np.isfinite(together)]) <= np.pi)
    small = np.array([each for each in angles if abs(each) < 3])
    assert np.array_equal(wrapped(small), small)


@given(poses, inputs)
def test_A_is_the_slope_of_f_in_the_state(x, u):
    assert np.allclose(robot.A(x, u), slope(lambda x: robot.f(x, u), x), atol=1e-6)


@given(poses)
def test_W_is_the_slope_of_f_in_the_wheel_speeds(x):
    def driven_by(wheels):
        left, right = wheels
        r, L = robot.wheel_radius, robot.track
        return robot.f(x, np.array([r * (right + left) / 2, r * (right - left) / L]))

    assert np.allclose(robot.W(x), slope(driven_by, np.array([3.0, -5.0])), atol=1e-6)


@given(poses)
def test_H_is_the_slope_of_h(x):
    assert np.allclose(robot.H(x), slope(robot.h, x), atol=1e-6)


@given(poses, st.integers(-1000, 1000))
def test_whole_turns_are_no_innovation(x, turns):
    turned = x + np.array([0, 0, turns * 2 * np.pi])
    assert np.allclose(robot.innovation(turned, x), 0, atol=1e-11)


def test_heading_innovation_of_half_a_turn_is_plus_pi():
    assert robot.innovation(np.array([0, 0, -np.pi]), np.zeros(3))[2] == np.pi
    assert robot.innovation(np.array([0, 0, np.pi]), np.zeros(3))[2] == np.pi


@given(poses, inputs, st.floats(0, 0.5))
def test_predict_is_27(x, u, spread):
    P = np.diag([1.0, 2.0, 3.0]) + spread
    A, W = robot.A(x, u), robot.W(x)
    prior, covariance = robot.predict(x, P, u)
    assert np.allclose(prior, robot.f(x, u), rtol=1e-14)
    assert np.allclose(covariance, A @ P @ A.T + W @ robot.Q @ W.T, rtol=1e-12, atol=1e-14)
