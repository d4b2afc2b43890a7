"""Which measurements say something about the estimate, and over which of them it is looked at."""

import numpy as np
import pytest
from scipy.stats import chi2

from laglab_control import Measured
from laglab_control.estimators.kalman import precision
from laglab_control.guard.evidence import (
    Evidence,
    Lag,
    contradiction,
    lagging,
    no_evidence,
    weighed,
    windows,
)

from .guarding import MODEL, P_0, U, driven, guarded, sampled


@pytest.mark.parametrize(
    ("there", "lengths"),
    [
        (11, []),
        (12, [12]),
        (30, [12, 30]),
        (40, [12, 40]),
        (199, [12, 40, 199]),
        (300, [12, 40, 200]),
    ],
)
def test_a_window_that_is_not_yet_full_is_looked_at_too(there: int, lengths: list[int]) -> None:
    assert windows(there) == lengths


def test_what_comes_late_is_used_but_is_no_evidence() -> None:
    guard, measured = guarded(), sampled(driven(30), seed=3)
    state = guard.start(np.zeros(3), P_0)
    for each in measured[1:]:
        state = guard.predict(state, U)
        state = guard.correct(state, [each] if each.tick != 20 else [])
    after = guard.correct(state, [measured[20]])
    assert not np.array_equal(after.x, state.x)
    assert after.evidence.newest == state.evidence.newest


@pytest.mark.parametrize(("settled", "gated"), [(18, 0), (19, 1)])
def test_it_says_something_when_the_inputs_that_led_there_are_known(
    settled: int, gated: int
) -> None:
    """Those up to `settled` lead to the pose of the tick after it."""
    guard, poses = guarded(), driven(30)
    state = guard.start(np.zeros(3), P_0)
    for _ in poses[1:]:
        state = guard.predict(state, U)
    wild = Measured(20, poses[20] + 5.0)
    assert guard.correct(state, [wild], (), settled).gated == gated


def test_a_wild_measurement_of_the_first_tick_is_not_used_either() -> None:
    guard = guarded()
    state = guard.start(np.zeros(3), P_0)
    after = guard.correct(state, [Measured(0, np.array((5.0, 0.0, 0.0)))])
    assert (after.gated, after.x.tolist()) == (1, [0.0, 0.0, 0.0])


@pytest.mark.parametrize(("beyond", "gated"), [(0.999, 0), (1.001, 1)])
def test_wild_is_what_a_sound_filter_sees_once_in_a_million(beyond: float, gated: int) -> None:
    guard = guarded()
    nis = float(chi2.isf(1e-6, 3)) * beyond
    z = np.linalg.cholesky(P_0 + MODEL.R) @ np.full(3, np.sqrt(nis / 3))
    assert guard.correct(guard.start(np.zeros(3), P_0), [Measured(0, z)]).gated == gated


UNIT = precision(np.eye(3))


def after(*nis: float, innovation: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Evidence:
    evidence = no_evidence()
    for each in nis:
        evidence = weighed(evidence, innovation, each)
    return evidence


def test_of_a_wild_one_only_that_it_is_wild_is_evidence() -> None:
    evidence = after(2.0, 3.0, innovation=(0.1, -0.2, 0.3))
    assert evidence.newest == pytest.approx((5.0, 0.2, -0.4, 0.6))
    for nis in (1e9, np.inf, np.nan):
        wild = weighed(evidence, (9.0, 9.0, 9.0), nis)
        assert wild.newest == pytest.approx((5.0 + chi2.isf(1e-6, 3), 0.2, -0.4, 0.6))


@pytest.mark.parametrize(("count", "there"), [(3, 3), (10, 10), (25, 25), (25, 60)])
@pytest.mark.parametrize(("beyond", "found"), [(0.999, False), (1.001, True)])
def test_the_last_25_that_sum_up_to_what_is_seen_once_in_a_million(
    count: int, there: int, beyond: float, found: bool
) -> None:
    each = float(chi2.isf(1e-6, 3 * count)) / count * beyond
    if there > count:
        evidence = after(*[each * 0.9] * (there - count), *[each] * count)
    else:
        evidence = after(*[each] * count)
    said = contradiction(evidence, None)
    assert (said is not None) is found
    if said:
        assert not said.drift
        assert f"the last {count} measurements" in said.cause
        assert f"add up to {each * count:.0f}, noise stays below" in said.cause


def test_of_two_nothing_is_said() -> None:
    assert contradiction(after(1e9, 1e9), None) is None
    assert contradiction(after(1e9, 1e9, 1e9), None) is not None


def test_the_mean_that_tells_most_is_claimed_at_each_third() -> None:
    """14 along x: those of all 14 tell more than those of the last 12."""
    evidence = after(*[1.0] * 14, innovation=(0.8, -0.6, 0.5))
    lag = lagging(evidence, UNIT, None)
    assert lag is not None
    assert lag.innovations == 14
    assert lag.mean == pytest.approx((0.8, -0.6, 0.5))
    assert lag.statistic == pytest.approx(14 * 1.25)
    evidence = weighed(evidence, (-50.0, 0.0, 0.0), 1.0)
    assert lagging(evidence, UNIT, lag) is lag
    evidence = weighed(evidence, (-50.0, 0.0, 0.0), 1.0)
    assert lagging(evidence, UNIT, lag) is lag
    evidence = weighed(evidence, (105.0, 0.0, 0.0), 1.0)
    later = lagging(evidence, UNIT, lag)
    assert later is not None
    assert (later.innovations, later.mean[0]) == (17, pytest.approx((14 * 0.8 + 5) / 17))


@pytest.mark.parametrize(("beyond", "claimed"), [(0.999, False), (1.001, True)])
def test_a_mean_is_claimed_that_is_seen_once_in_a_thousand(beyond: float, claimed: bool) -> None:
    b = float(np.sqrt(chi2.isf(1e-3, 3) * beyond / 14))
    evidence = after(*[1.0] * 14, innovation=(0.0, b, 0.0))
    assert (lagging(evidence, UNIT, None) is not None) is claimed


@pytest.mark.parametrize(("beyond", "found"), [(0.999, False), (1.001, True)])
def test_an_estimate_lags_behind_where_a_mean_is_no_noise(beyond: float, found: bool) -> None:
    lag = Lag(40, (0.1, -0.2, 0.3), float(chi2.isf(3e-6, 3)) * beyond)
    said = contradiction(no_evidence(), lag)
    assert (said is not None) is found
    if said:
        assert said.drift
        assert "the last 40 measurements" in said.cause
        assert "by 0.100 m, -0.200 m, 0.300 rad" in said.cause
