"""Measurements late, missing, repeated, out of order, too old: what each filter does with them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_control import (
    DelayedEkf,
    Ekf,
    LiteralPopf,
    Measured,
    Popf,
    PopfExact,
    Rewinding,
    RigidMotions,
    StampError,
)

from .textbook import ROBOT, ekf_in_order

TICKS = 50
RANDOM = np.random.default_rng(11)
INPUTS = RANDOM.normal(size=(TICKS, 2)) * 2
MEASUREMENTS = RANDOM.normal(size=(TICKS + 1, 3)) * 0.2
X_0, P_0 = np.zeros(3), np.diag([0.01, 0.02, 0.03])


def made(memory):
    return {
        "ekf": Ekf(ROBOT),
        "popf": Popf(ROBOT, memory=memory),
        "popf-exact": PopfExact(ROBOT, memory=memory),
        "delayed-ekf": DelayedEkf(ROBOT, RigidMotions(ROBOT), memory=memory),
        "rewinding popf": Rewinding(Popf(ROBOT, memory=memory), memory=memory),
    }


def run(estimator, arrivals):
    """`arrivals[k]` lists the sampling ticks of what arrives at tick k."""
    state = estimator.start(X_0, P_0)
    for k in range(TICKS + 1):
        state = estimator.predict(state, INPUTS[k - 1]) if k else state
        arrived = [Measured(s, MEASUREMENTS[s]) for s in arrivals.get(k, [])]
        state = estimator.correct(state, arrived)
    return state


@st.composite
def links(draw):
    """For each measurement the delays of its copies: none is a loss, two a repeat."""
    arrivals = {}
    for s in range(TICKS + 1):
        for delay in draw(st.lists(st.integers(0, 15), max_size=2)):
            arrivals.setdefault(s + delay, []).append(s)
    return {k: draw(st.permutations(batch)) for k, batch in arrivals.items() if k <= TICKS}


@settings(max_examples=40)
@given(links())
def test_popf_does_what_its_equations_say(arrivals):
    fast, literal = (run(popf(ROBOT), arrivals) for popf in (Popf, LiteralPopf))
    scale = 1 + np.abs(literal.P).max()
    assert np.abs(fast.x - literal.x).max() < 1e-9 * scale
    assert np.abs(fast.P - literal.P).max() < 1e-9 * scale


@settings(max_examples=40)
@given(links())
def test_delayed_ekf_is_the_ekf_that_had_everything_in_order(arrivals):
    used = {s: MEASUREMENTS[s] for batch in arrivals.values() for s in batch}
    x, P = ekf_in_order(X_0, P_0, INPUTS, used)
    state = run(DelayedEkf(ROBOT, RigidMotions(ROBOT)), arrivals)
    assert np.abs(state.x - x).max() < 1e-10
    assert np.abs(state.P - P).max() < 1e-10


@pytest.mark.parametrize("name", list(made(8)))
def test_what_is_older_than_the_memory_changes_nothing(name):
    estimator = made(8)[name]
    fresh = {k: [k] for k in range(30, TICKS + 1, 3)}
    a, b = run(estimator, fresh), run(estimator, {**fresh, TICKS: [5, 0]})
    np.testing.assert_array_equal(a.x, b.x)
    np.testing.assert_array_equal(a.P, b.P)


@pytest.mark.parametrize("name", list(made(8)))
def test_a_long_silence_then_a_measurement(name):
    """The memory is bounded: the past does not grow with the silence."""
    estimator = made(8)[name]
    state = run(estimator, {})
    corrected = estimator.correct(state, [Measured(TICKS - 3, MEASUREMENTS[0])])
    assert np.abs(corrected.x - state.x).max() > 1e-4
    assert np.trace(corrected.P) < np.trace(state.P)


@pytest.mark.parametrize("name", list(made(8)))
@pytest.mark.parametrize("stamp", [-1, TICKS + 1])
def test_stamps_that_cannot_be_are_refused(name, stamp):
    estimator = made(8)[name]
    state = run(estimator, {})
    with pytest.raises(StampError, match=f"sampled at tick .*{stamp}.*, at tick {TICKS}: give"):
        estimator.correct(state, [Measured(stamp, X_0), Measured(TICKS, X_0)])


@pytest.mark.parametrize("name", ["ekf", "popf-exact"])
def test_these_take_no_measurement_older_than_one_already_used(name):
    estimator = made(1024)[name]
    once = run(estimator, {20: [15], 30: [25]})
    again = run(estimator, {20: [15], 30: [25], 31: [18], 40: [10]})
    np.testing.assert_array_equal(once.x, again.x)
