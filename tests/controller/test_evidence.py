"""Which measurements say something about the estimate, and over which of them it is looked at."""

import numpy as np
import pytest
from scipy.stats import chi2

from laglab_control import Measured
from laglab_control.guard.evidence import windows

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
