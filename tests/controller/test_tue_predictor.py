"""The predictor of Eindhoven: it converges where its theory says, and claims nothing."""

import math

import numpy as np
import pytest

from laglab_control import ConfigError, Measured, RobotModel, TuePredictor

MODEL = RobotModel()
P = np.eye(3) * 1e-4
AWAY = np.array([0.3, -0.2, 0.1])


def errors(gain: float, m: int, ticks: int, drives: bool = True) -> np.ndarray:
    """|x^_k - x_k| of a copy that begins elsewhere, with noise off."""
    predictor = TuePredictor(MODEL, gain, gain, gain)
    true = [np.array([0.0, 0.0, 0.0])]
    state = predictor.start(true[0] + AWAY, P)
    off = []
    for k in range(ticks):
        u = np.array([0.5, 0.4 * math.sin(0.02 * k)]) if drives else np.zeros(2)
        if k >= m:
            state = predictor.correct(state, [Measured(k - m, true[k - m])])
        off.append(np.abs(state.x - true[k]))
        true.append(MODEL.f(true[k], u))
        state = predictor.predict(state, u)
    return np.array(off)


@pytest.mark.parametrize("m", [0, 5, 20, 60])
def test_a_copy_that_begins_elsewhere_comes_to_where_the_robot_is(m: int) -> None:
    off = errors(gain=2.0 if m < 60 else 1.0, m=m, ticks=2500)
    assert off[m].max() > 0.1
    assert off[-1].max() < 1e-6


@pytest.mark.parametrize("m", [5, 20, 60])
def test_the_gain_that_a_delay_allows(m: int) -> None:
    """Of e_{k+1} = e_k - Ts K e_{k-m}, that is K < 2 sin(pi/(2(2m+1)))/Ts."""
    limit = 2 * math.sin(math.pi / (2 * (2 * m + 1))) / MODEL.sample_time
    below, above = (errors(share * limit, m, 40 * m + 500, drives=False) for share in (0.9, 1.1))
    assert below[-2 * m :, 2].max() < 0.5 * below[: 4 * m, 2].max()
    assert above[-2 * m :, 2].max() > 2 * abs(AWAY[2])


def test_begun_where_the_robot_is_it_stays_there() -> None:
    predictor = TuePredictor(MODEL)
    x = np.array([1.0, 2.0, 0.5])
    state = predictor.start(x, P)
    for k in range(50):
        u = np.array([1.0, -0.5])
        state, x = predictor.predict(state, u), MODEL.f(x, u)
        state = predictor.correct(state, [Measured(k + 1, x)])
        np.testing.assert_array_equal(state.x, x)


def test_an_older_measurement_and_one_beyond_its_memory_change_nothing() -> None:
    predictor = TuePredictor(MODEL)
    state = predictor.start(np.zeros(3), P)
    for _ in range(3000):
        state = predictor.predict(state, np.zeros(2))
    assert predictor.correct(state, [Measured(5, AWAY)]) is state
    state = predictor.correct(state, [Measured(2990, AWAY)])
    assert predictor.correct(state, [Measured(2989, AWAY), Measured(2990, AWAY)]) is state


def test_it_claims_and_weighs_nothing() -> None:
    predictor = TuePredictor(MODEL)
    state = predictor.correct(predictor.start(np.zeros(3), P), [Measured(0, AWAY)])
    assert state.P is None
    assert predictor.innovation(state) is None
    assert not predictor.is_watchable


def test_with_no_gains_told_each_is_2_a_second() -> None:
    """Ts K = 0.02 of what is seen, for a copy that looks along x."""
    predictor = TuePredictor(MODEL)
    z = np.array([1.0, -2.0, 3.0])
    state = predictor.correct(predictor.start(np.zeros(3), P), [Measured(0, z)])
    np.testing.assert_allclose(state.x, 0.02 * z, rtol=0, atol=1e-15)


def test_the_heading_is_wrapped_and_the_gains_are_the_robots_own() -> None:
    predictor = TuePredictor(MODEL, k_x=10.0, k_y=1.0, k_theta=5.0)
    state = predictor.start(np.array([0.0, 0.0, math.pi / 2]), P)
    ahead = predictor.correct(state, [Measured(0, np.array([0.0, 1.0, math.pi / 2 + 2 * math.pi]))])
    np.testing.assert_allclose(ahead.x, [0.0, 0.1, math.pi / 2], atol=1e-12)
    aside = predictor.correct(state, [Measured(0, np.array([1.0, 0.0, math.pi / 2]))])
    np.testing.assert_allclose(aside.x, [0.01, 0.0, math.pi / 2], atol=1e-12)


@pytest.mark.parametrize("gain", [0.0, -1.0, math.nan])
def test_what_is_no_gain_is_refused(gain: float) -> None:
    with pytest.raises(ConfigError, match="k_y must be"):
        TuePredictor(MODEL, k_y=gain)
