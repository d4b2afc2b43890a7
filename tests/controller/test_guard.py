"""An estimator that is watched: what it is told, and what the guard makes of it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_control import ESTIMATORS, Controller, Guard, InForce, Measured, StationConfig
from laglab_control.guard import Watched
from laglab_control.model import Matrix, Vector

from .guarding import MODEL, P_0, M, U, alarms, driven, followed, guarded, sampled


@pytest.mark.parametrize("name", [name for name in ESTIMATORS if name != "raw"])
def test_while_nothing_is_wrong_it_is_the_estimator_bit_for_bit(name: str) -> None:
    measured = sampled(driven(60), seed=1)
    alone = followed(ESTIMATORS[name].make(MODEL), measured)
    for said, watched in zip(alone, followed(guarded(name), measured), strict=True):
        assert said.x is not None
        assert watched.tick == said.tick
        assert np.array_equal(said.x, watched.x)
        assert np.array_equal(said.P, watched.P)


@pytest.mark.parametrize(("name", "watched"), [("raw", False), ("popf", True)])
def test_who_expects_nothing_is_not_watched(name: str, watched: bool) -> None:
    controller = Controller(StationConfig(name, guard=True))
    assert isinstance(controller.start().estimate, Watched) is watched


def test_noise_alone_raises_no_alarm() -> None:
    for seed in range(30):
        states = followed(guarded(), sampled(driven(300), seed))
        assert alarms(states) == []
        assert states[-1].gated == 0


@pytest.mark.parametrize("wild", [(50.0, 0.0, 0.0), (0.0, 0.9, 0.0), (0.0, 0.0, np.pi)])
def test_a_wild_measurement_is_not_used_but_counted(wild: tuple[float, float, float]) -> None:
    measured = sampled(driven(100), seed=2)
    measured[50] = Measured(50, measured[50].z + wild)
    states = followed(guarded(), measured)
    without = measured.copy()
    without[50] = without[49]  # a repeat: nothing new
    for state, never in zip(states, followed(guarded(), without), strict=True):
        assert np.array_equal(state.x, never.x)
    assert states[-1].gated == 1
    assert alarms(states) == []


def test_a_wild_one_that_is_late_and_told_twice_is_not_used_either() -> None:
    guard, measured = guarded(), sampled(driven(30), seed=3)
    state = guard.start(np.zeros(3), P_0)
    for each in measured[1:]:
        state = guard.predict(state, U)
        if each.tick != 20:
            state = guard.correct(state, [each])
    wild = Measured(20, measured[20].z + 5.0)
    after = guard.correct(state, [wild, wild])
    assert np.array_equal(after.x, state.x)
    assert after.gated == 1


def moved(at: int, ticks: int) -> list[Vector]:
    """The poses of a robot that somebody puts elsewhere, turned, and that drives on from there."""
    return driven(at - 1) + driven(ticks - at, start=(0.9, -0.4, -2.0))


@pytest.mark.parametrize("name", ["popf", "popf-exact", "delayed-ekf"])
def test_a_robot_that_is_elsewhere_is_found_again(name: str) -> None:
    poses = moved(at=150, ticks=400)
    states = followed(guarded(name), sampled(poses, seed=4))
    (alarm,) = alarms(states)
    assert 150 + M <= alarm.tick < 150 + M + 10
    assert "are not where the estimate has the robot" in alarm.cause
    last = states[len(poses) - 1]
    assert np.abs(MODEL.innovation(poses[-1], last.x)).max() < 0.05


def test_of_a_robot_that_is_found_again_the_heading_is_counted_on() -> None:
    """As many turns as before: nothing wraps the heading of a state."""
    turns = 4 * np.pi
    poses = driven(60, start=(0.0, 0.0, turns)) + driven(60, start=(2.0, -1.0, 0.5))
    states = followed(guarded(), sampled(poses, seed=4), poses[0])
    (k,) = [k for k, state in enumerate(states) if state.alarm]
    assert abs(states[k].x[2] - states[k - 1].x[2]) < np.pi
    assert states[len(poses) - 1].x[2] == pytest.approx(poses[-1][2] + turns, abs=0.2)


def test_inputs_that_are_told_after_an_alarm_are_put_right_where_they_belong() -> None:
    """The robot was put elsewhere at tick 40; at ticks 60 ... 69 it stood, as is told later."""
    stood = [InForce(j, np.zeros(2)) for j in range(59, 69)]
    poses = driven(39)
    poses += driven(69, [U] * 19 + [each.u for each in stood] + [U] * 40, start=(2.0, -1.0, 0.5))
    guard = guarded()
    state = guard.start(poses[0], P_0)
    for k, pose in enumerate(poses[1:], start=1):
        state = guard.predict(state, U)
        state = guard.correct(state, [Measured(k, pose)] if k < 60 else [], settled=59)
    assert state.origin > 0
    assert np.hypot(*(state.x - poses[-1])[:2]) > 0.03
    state = guard.correct(state, [], stood)
    assert np.hypot(*(state.x - poses[-1])[:2]) < 1e-6


def test_the_error_after_an_alarm_is_what_is_claimed() -> None:
    nees = []
    for seed in range(40):
        poses = moved(at=40, ticks=240)
        states = followed(guarded(), sampled(poses, seed))
        last = states[len(poses) - 1]
        assert len(alarms(states)) == 1
        e = MODEL.innovation(poses[-1], last.x)
        nees.append(e @ np.linalg.solve(last.P, e))
    assert 1.5 < np.mean(nees) < 5.0


def test_a_drift_that_noise_hides_is_seen_too() -> None:
    """The robot slides sideways by 4 cm/s; its sensor's noise is 10 cm."""
    sliding = [pose + np.array((0.0, 0.0004 * k, 0.0)) for k, pose in enumerate(driven(500))]
    first, *_ = alarms(followed(guarded(), sampled(sliding, seed=5)))
    assert "on one side of the estimate" in first.cause


def worn(ticks: int) -> list[Vector]:
    """The poses of a robot whose wheels lead a tenth too far."""
    return driven(ticks, [U * 1.1] * ticks)


def test_where_the_estimate_lags_behind_one_that_learns_takes_over() -> None:
    learner = ESTIMATORS["calibrating-ekf"].make(MODEL)
    guard = Guard(ESTIMATORS["delayed-ekf"].make(MODEL), MODEL, learner)
    poses = worn(900)
    states = followed(guard, sampled(poses, seed=9))
    (alarm,) = alarms(states)
    assert "on one side" in alarm.cause
    last = states[len(poses) - 1]
    assert last.learning
    assert guard.learned(states[0]) == ()
    assert len(guard.learned(last)) == 2
    for scale in guard.learned(last):
        assert abs(scale.value - 0.1) < 4 * scale.deviation
    assert np.abs(MODEL.innovation(poses[-1], last.x)).max() < 0.08


def test_without_one_that_learns_the_pose_is_found_again_and_again() -> None:
    states = followed(guarded(), sampled(worn(900), seed=9))
    assert len(alarms(states)) > 1
    assert not states[-1].learning


def test_one_that_has_learned_keeps_it_when_the_robot_is_moved() -> None:
    learner = ESTIMATORS["calibrating-ekf"].make(MODEL)
    guard = Guard(ESTIMATORS["delayed-ekf"].make(MODEL), MODEL, learner)
    poses = worn(600)
    poses += [np.array((3.0, -1.0, 1.0))]
    for _ in range(60):
        poses.append(MODEL.f(poses[-1], U * 1.1))
    states = followed(guard, sampled(poses, seed=10))
    drifting, elsewhere = alarms(states)
    assert "on one side" in drifting.cause
    assert 600 <= elsewhere.tick - M < 610
    before, after = (guard.learned(states[k]) for k in (elsewhere.tick - 10, elsewhere.tick))
    assert [each.value for each in after] == pytest.approx(
        [each.value for each in before], abs=0.05
    )
    assert np.hypot(*(states[len(poses) - 1].x - poses[-1])[:2]) < 0.1


def test_what_the_robot_did_unheard_proves_nothing() -> None:
    """Inputs are not known after tick 100: the robot stands, the estimate drives on."""
    poses = driven(100)
    poses += [poses[-1]] * 100
    guard, measured = guarded(), sampled(poses, seed=6)
    state = guard.start(np.zeros(3), P_0)
    for k in range(1, 200):
        state = guard.predict(state, U)
        state = guard.correct(state, [measured[k]] if k < 100 or k > 160 else [], settled=99)
        assert state.alarm is None
    assert state.gated == 0
    stood = [InForce(j, np.zeros(2)) for j in range(100, 199)]
    known = guard.correct(state, [], stood, settled=198)
    assert np.hypot(*(known.x - poses[-1])[:2]) < 0.05
    assert guard.correct(known, [Measured(199, measured[199].z)], (), 198).alarm is None


@settings(max_examples=25)
@given(
    late=st.lists(st.integers(0, 30), min_size=150, max_size=150),
    twice=st.sets(st.integers(1, 149)),
    seed=st.integers(0, 1000),
)
def test_disorder_and_repeats_change_nothing_in_the_end(
    late: list[int], twice: set[int], seed: int
) -> None:
    guard, measured = guarded(), sampled(driven(150), seed)
    arriving: dict[int, list[Measured]] = {}
    for each, by in zip(measured[1:], late, strict=True):
        arriving.setdefault(each.tick + by, []).append(each)
        if each.tick in twice:
            arriving.setdefault(each.tick + by + 3, []).append(each)
    state = guard.start(np.zeros(3), P_0)
    alone = guard.estimator.start(np.zeros(3), P_0)
    for k in range(1, 185):
        state, alone = guard.predict(state, U), guard.estimator.predict(alone, U)
        state = guard.correct(state, arriving.get(k, []))
        alone = guard.estimator.correct(alone, arriving.get(k, []))
        assert state.alarm is None
    assert state.gated == 0
    assert np.allclose(state.x, alone.x, rtol=0, atol=1e-12)


def test_measurements_that_are_not_finite_do_not_reach_the_estimate() -> None:
    measured = sampled(driven(60), seed=7)
    measured[30] = Measured(30, np.array((np.nan, 0.0, np.inf)))
    states = followed(guarded(), measured)
    assert np.isfinite(states[-1].x).all()
    assert states[-1].gated == 1


def test_states_are_not_touched() -> None:
    guard, measured = guarded("popf"), sampled(driven(40), seed=8)
    states = followed(guard, measured)
    kept: list[tuple[Vector, Matrix]] = [(s.x.copy(), s.P.copy()) for s in states]
    for state in states[:-1]:
        guard.correct(guard.predict(state, U * 3), [Measured(state.tick, np.ones(3))])
    for state, (x, P) in zip(states, kept, strict=True):
        assert np.array_equal(state.x, x)
        assert np.array_equal(state.P, P)


@pytest.mark.parametrize("bad", [(np.nan, 0.0, 0.0), (0.0, 0.0, np.nan), (0.0, 0.0, np.inf)])
@pytest.mark.parametrize("settled", [None, 20])
def test_of_what_is_not_finite_there_may_be_any_number(
    bad: tuple[float, float, float], settled: int | None
) -> None:
    """It says nothing, also where nothing is proved: nobody can begin again from there."""
    guard, measured = guarded(), sampled(driven(60), seed=7)
    state = guard.start(np.zeros(3), P_0)
    for k, (tick, z) in enumerate(measured[1:], start=1):
        state = guard.predict(state, U)
        said = Measured(tick, np.array(bad) if 30 <= k < 40 else z)
        state = guard.correct(state, [said], (), settled)
        assert state.alarm is None
        assert np.isfinite(state.x).all()
    assert state.gated == 10


def test_who_learns_is_asked_for_what_must_not_be_overlooked() -> None:
    """Not the estimator that it took over from, which does not know its states."""
    learner = ESTIMATORS["calibrating-ekf"].make(MODEL)
    guard = Guard(ESTIMATORS["popf"].make(MODEL), MODEL, learner)
    last = followed(guard, sampled(worn(250), seed=9))[-1]
    assert last.learning
    assert guard.warning(last) is None
