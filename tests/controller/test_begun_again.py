"""What a guard keeps in order when an estimate begins again, and when inputs are put right."""

import numpy as np
import pytest

from laglab_control import Guard, InForce, Measured
from laglab_control.angle import wrap
from laglab_control.guard import Watched
from laglab_control.guard.guard import LOCATING
from laglab_control.laws.interface import STAND
from laglab_control.model import Vector
from laglab_control.past.memory import MEMORY

from .guarding import MODEL, P_0, U, driven, guarded

AT = 30
"""At this tick the robot is elsewhere."""


def poses(ticks: int) -> list[Vector]:
    return driven(AT - 1) + driven(ticks, start=(2.0, -1.0, 0.5))


def lost(guard: Guard) -> Watched:
    """Whose pose has just begun to be found again; without noise, at once what is measured."""
    state = guard.start(np.zeros(3), P_0)
    for k, pose in enumerate(poses(60)[1:], start=1):
        state = guard.correct(guard.predict(state, U), [Measured(k, pose)])
        if state.alarm:
            return state
    raise AssertionError("no alarm")


def test_after_so_many_measurements_the_estimator_goes_on_with_the_pose_that_was_found() -> None:
    guard = guarded("popf")
    state = lost(guard)
    there, kind = poses(300), type(state.aside)

    def one_more(state: Watched) -> Watched:
        k = state.tick + 1
        return guard.correct(guard.predict(state, U), [Measured(k, there[k])])

    wild = Measured(state.tick + 1, np.array((90.0, 0.0, 0.0)))
    state = guard.correct(guard.predict(state, U), [wild])
    for used in range(2, LOCATING):
        state = one_more(state)
        assert state.aside is not None, used
    state = one_more(state)
    assert state.aside is None
    assert type(state.state) is kind
    assert (state.origin, state.state.tick) == (state.tick, 0)
    assert state.x == pytest.approx(there[state.tick], abs=1e-9)
    assert state.P is not None
    assert state.P.max() < MODEL.R.max() / 20


def test_what_was_learned_is_kept_while_the_pose_is_found() -> None:
    guard = guarded("calibrating-ekf")
    state = lost(guard)
    assert state.aside is not None
    assert len(guard.learned(state)) == 2
    assert guard.learned(state) == guard.estimator.learned(state.aside)
    assert guard.calibrated(state, MODEL) is not MODEL


def test_the_error_that_the_innovations_suggest_is_claimed_too() -> None:
    guard = guarded()
    state = guard.start(np.zeros(3), P_0)
    k = 0
    while state.lag is None:
        k += 1
        shifted = Measured(k, driven(k)[k] + (0.12, 0.0, 0.0))
        state = guard.correct(guard.predict(state, U), [shifted])
    b, P = state.lag.mean, state.state.P
    assert P is not None
    assert abs(b[0]) > 0.05
    np.testing.assert_allclose(state.P, P + np.outer(b, b), rtol=1e-12)


def test_an_estimate_that_is_no_number_begins_again_too() -> None:
    guard = guarded()
    state = guard.start(np.full(3, np.nan), P_0)
    with np.errstate(invalid="ignore"):
        for k, pose in enumerate(driven(10)[1:], start=1):
            state = guard.correct(guard.predict(state, U), [Measured(k, pose)])
    assert state.x == pytest.approx(driven(10)[10], abs=1e-9)


def test_an_input_is_put_right_from_the_very_first_on() -> None:
    guard = guarded()
    alone, state = guard.estimator.start(np.zeros(3), P_0), guard.start(np.zeros(3), P_0)
    for u in (STAND, U, U):
        alone, state = guard.estimator.predict(alone, u), guard.predict(state, U)
    state = guard.correct(state, [], [InForce(0, STAND)])
    assert state.x == pytest.approx(alone.x, abs=1e-15)
    items, length = state.inputs
    assert [u.tolist() for u in items[:length]] == [STAND.tolist(), U.tolist(), U.tolist()]


def test_so_is_the_first_after_the_estimate_has_begun_again() -> None:
    guard = guarded()
    state = lost(guard)
    began = state.x
    state = guard.predict(state, U)
    state = guard.correct(state, [], [InForce(state.origin, STAND)])
    assert state.x == pytest.approx(began, abs=1e-12)


def test_what_is_prepared_for_is_counted_from_where_the_estimate_began() -> None:
    guard = guarded("popf")
    state = guard.start(np.zeros(3), P_0)._replace(origin=10)
    state = guard.predict(guard.predict(state, U), U)
    assert state.tick == 12
    assert guard.expect(state, 11).state.state.expected.s == 1


@pytest.mark.parametrize("before", [7.0, -9.0, 20.0, 0.5])
def test_the_heading_begins_again_in_the_turn_where_it_was(before: float) -> None:
    guard = guarded()
    state = guard.start(np.array((0.0, 0.0, before)), P_0)
    for k in range(1, 6):
        z = np.array((5.0, 0.0, wrap(before + 2.5)))
        state = guard.correct(guard.predict(state, STAND), [Measured(k, z)])
        if state.alarm:
            assert state.x == pytest.approx([5.0, 0.0, before + 2.5])
            return
    raise AssertionError("no alarm")


def test_after_a_long_time_an_input_is_put_right_at_its_tick() -> None:
    """What is older than anybody remembers is not."""
    guard, ticks = guarded(), 2 * MEMORY + 10
    state = guard.start(np.zeros(3), P_0)
    for k in range(ticks):
        state = guard.predict(state, STAND)
        if k == ticks - 20:
            state = guard.correct(state, [Measured(k, np.zeros(3))])
    state = guard.correct(state, [], [InForce(5, U), InForce(ticks - 5, U)])
    assert state.x == pytest.approx(driven(1)[1], abs=1e-9)
    items, length = state.inputs
    assert [i - length for i, u in enumerate(items[:length]) if u is U] == [-5]
