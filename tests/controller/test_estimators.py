"""What each estimator's definition says, checked against the definition written out plainly."""

import numpy as np
import pytest

from laglab_control import (
    ESTIMATORS,
    DelayedEkf,
    Ekf,
    InForce,
    LiteralPopf,
    Measured,
    Popf,
    ReplayedInputs,
    RigidMotions,
    RobotModel,
    SpeedLimits,
    constant_delay,
    replay,
)

from . import textbook

robot = textbook.ROBOT
P0 = np.eye(3) * 1e-3


@pytest.fixture
def record(simulate):
    """A noisy drive of 300 ticks to replay."""
    return simulate(
        "delayed-ekf", noise=5, ticks=300, p0=1e-3, limits=SpeedLimits(v_max=2, omega_max=3)
    )


def run(estimator, record, m):
    return replay(
        estimator,
        record.poses[0],
        P0,
        record.inputs,
        constant_delay(record.measurements, m),
    )


def literal_delayed_ekf(record, m):
    """At every tick, the EKF over everything that has arrived, from tick 0 on."""
    beliefs = [
        textbook.ekf_in_order(
            record.poses[0],
            P0,
            record.inputs[:k],
            dict(enumerate(record.measurements[: max(k - m + 1, 0)])),
        )
        for k, _ in enumerate(record.poses)
    ]
    return map(np.array, zip(*beliefs, strict=True))


@pytest.mark.parametrize("m", [0, 1, 7, 20])
def test_popf_is_its_equations_written_out(record, m):
    fast, literal = (run(popf(robot), record, m) for popf in (Popf, LiteralPopf))
    assert np.abs(fast.estimates - literal.estimates).max() < 1e-12
    assert np.abs(fast.covariances - literal.covariances).max() < 1e-12
    assert np.abs(fast.nis - literal.nis)[m:].max() < 1e-9


@pytest.mark.parametrize("m", [0, 1, 20])
@pytest.mark.parametrize("windows", [RigidMotions(robot), ReplayedInputs(robot)])
def test_delayed_ekf_is_roll_back_and_replay(record, m, windows):
    estimates, covariances = literal_delayed_ekf(record, m)
    answer = run(DelayedEkf(robot, windows), record, m)
    assert np.abs(answer.estimates - estimates).max() < 1e-12
    assert np.abs(answer.covariances - covariances).max() < 1e-12


@pytest.mark.parametrize("name", ["popf", "popf-printed", "popf-exact", "delayed-ekf"])
def test_without_delay_it_is_the_ekf(record, name):
    ekf, other = run(Ekf(robot), record, 0), run(ESTIMATORS[name].make(robot), record, 0)
    assert np.abs(ekf.estimates - other.estimates).max() < 1e-12
    assert np.abs(ekf.covariances - other.covariances).max() < 1e-12


def test_ekf_takes_a_late_measurement_for_a_fresh_one(record):
    late = run(Ekf(robot), record, 5).estimates
    x, P = record.poses[0], P0
    for k, u in enumerate(record.inputs, start=1):
        x, P = textbook.predict(x, P, u)
        if k >= 5:
            x, P = textbook.correct(x, P, record.measurements[k - 5])
        assert np.abs(late[k] - x).max() < 1e-10 or k < 5


@pytest.mark.parametrize("name", ["popf", "popf-printed", "popf-exact", "ekf"])
def test_before_the_first_measurement_it_only_predicts(record, name):
    answer = run(ESTIMATORS[name].make(robot), record, 20)
    x, P = record.poses[0], P0
    for k in range(1, 20):
        x, P = textbook.predict(x, P, record.inputs[k - 1])
        assert np.allclose(answer.estimates[k], x, atol=1e-14)
        assert np.allclose(answer.covariances[k], P, atol=1e-16)


@pytest.mark.parametrize("name", ["popf", "popf-exact", "delayed-ekf", "calibrating-ekf"])
@pytest.mark.parametrize("m", [0, 3, 20])
def test_without_noise_the_estimate_is_exact_at_every_tick(simulate, name, m):
    record = simulate(name, m=m, ticks=500)
    assert np.abs(record.estimates - record.poses).max() < 1e-11


@pytest.mark.parametrize("name", list(ESTIMATORS))
def test_a_repeated_measurement_changes_nothing(record, name):
    once = constant_delay(record.measurements, 3)
    again = [[*new, *old] for new, old in zip(once, [[], *once], strict=False)]
    estimator, start = ESTIMATORS[name].make(robot), (record.poses[0], P0, record.inputs)
    np.testing.assert_array_equal(
        replay(estimator, *start, once).estimates, replay(estimator, *start, again).estimates
    )


def test_delayed_ekf_does_not_mind_the_order(record):
    """Everything that was measured, each with its own delay, some together: all are used."""
    random = np.random.default_rng(3)
    arrivals = [[] for _ in record.poses]
    for s, z in enumerate(record.measurements):
        arrivals[min(s + random.integers(0, 60), 300)].append(Measured(s, z))
    ordered = replay(
        Ekf(robot), record.poses[0], P0, record.inputs, constant_delay(record.measurements, 0)
    )
    for windows in (RigidMotions(robot), ReplayedInputs(robot)):
        answer = replay(DelayedEkf(robot, windows), record.poses[0], P0, record.inputs, arrivals)
        assert np.abs(answer.estimates[-1] - ordered.estimates[-1]).max() < 1e-12
        assert np.abs(answer.covariances[-1] - ordered.covariances[-1]).max() < 1e-12


@pytest.mark.parametrize("wrong", [3, 200, 299])
def test_delayed_ekf_puts_a_wrong_input_right(record, wrong):
    """Told at the last tick what was really in force at another, it is as if it had known."""
    estimator = DelayedEkf(robot, RigidMotions(robot))
    believed = record.inputs.copy()
    believed[wrong] = [0.7, -2.0]
    arrivals = constant_delay(record.measurements, 20)
    state = estimator.start(record.poses[0], P0)
    for k, measurements in enumerate(arrivals):
        state = estimator.predict(state, believed[k - 1]) if k else state
        told = [InForce(wrong, record.inputs[wrong])] if k == 300 else []
        state = estimator.correct(state, measurements, told)
    right = run(estimator, record, 20)
    assert np.abs(state.x - right.estimates[-1]).max() < 1e-12
    assert np.abs(state.P - right.covariances[-1]).max() < 1e-12


def test_what_is_prepared_for_a_measurement_hides_nothing_of_the_last_one():
    popf = Popf(RobotModel())
    state = popf.predict(popf.start(np.zeros(3), np.eye(3)), np.array((1.0, 0.0)))
    state = popf.correct(state, [Measured(0, np.ones(3))])
    before, after = popf.innovation(state), popf.innovation(popf.expect(state, 1))
    assert before is not None
    assert after is not None
    np.testing.assert_array_equal(before.value, after.value)


@pytest.mark.parametrize("name", ["popf", "popf-printed"])
def test_what_is_prepared_for_a_measurement_is_of_no_use_where_another_comes(record, name):
    popf = ESTIMATORS[name].make(robot)
    state = popf.start(record.poses[0], P0)
    for u in record.inputs[:30]:
        state = popf.predict(state, u)
    came = [Measured(12, record.measurements[12])]
    plain, prepared = popf.correct(state, came), popf.correct(popf.expect(state, 25), came)
    np.testing.assert_array_equal(prepared.x, plain.x)
    np.testing.assert_array_equal(prepared.P, plain.P)
