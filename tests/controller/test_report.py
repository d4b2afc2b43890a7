"""What the station says of itself."""

import re

import numpy as np
import pytest

from laglab_control import ESTIMATORS, Measured, RobotModel, StationConfig
from laglab_control.estimators.paper.popf import delay_limit
from laglab_protocol import (
    MAV_SEVERITY_EMERGENCY,
    MAV_SEVERITY_ERROR,
    Measurement,
    Sender,
    Statustext,
    Tick,
    frames_in,
)
from laglab_station import Station
from laglab_station.warned import MOST_TOLD, Warnings

LATE = 20


def run(estimator, p0, ticks=60, clock=None, guard=False):
    """A robot at rest whose measurements come 20 ticks late; the station's report."""
    config = StationConfig(estimator=estimator, initial_covariance=np.eye(3) * p0, guard=guard)
    station, robot = Station(config, clock=clock), Sender(1, 1)
    for k in range(ticks):
        late = [Measurement(0.0, 0.0, 0.0, 0.0, 0.0, k - LATE, -1)] if k >= LATE else []
        messages = [*late, Tick(k, len(late))]
        station.hear(frames_in(b"".join(map(robot.frame, messages))))
    return station.report()


def test_the_limit_is_the_one_of_the_scalar_recursion():
    """Just below it x~_{k+1} = x~_k - K x~_{k-m} dies away, just above it grows."""
    assert delay_limit(20) == pytest.approx(0.077, abs=5e-4)
    assert delay_limit(0) == pytest.approx(2.0)
    for m in (0, 1, 5):
        for factor, grows in ((0.98, False), (1.02, True)):
            errors = [1.0] * (m + 1)
            for _ in range(4000):
                errors.append(errors[-1] - factor * delay_limit(m) * errors[-1 - m])
            assert (max(map(abs, errors[-50:])) > 1) is grows


@pytest.mark.parametrize("estimator", ["popf", "popf-printed"])
def test_a_gain_above_the_limit_is_warned_of_once(estimator):
    (warning,) = run(estimator, p0=1e-3).warnings
    assert re.match(r"tick 20: popf's gain is 0\.\d+; above 0\.077 a delay of 20 ticks", warning)
    assert "take a smaller P_0, or delayed-ekf" in warning


@pytest.mark.parametrize(("estimator", "p0"), [("popf", 1e-4), ("delayed-ekf", 1.0), ("raw", 1.0)])
def test_otherwise_nothing_is_warned_of(estimator, p0):
    assert run(estimator, p0).warnings == ()


@pytest.mark.parametrize("estimator", ["raw", "tue-predictor"])
def test_a_guard_that_can_do_nothing_is_warned_of(estimator):
    (warning,) = run(estimator, p0=1e-4, guard=True).warnings
    told = f"{estimator} does not show what is wild: estimator.guard does nothing"
    assert warning == f"tick 20: {told}"
    assert run("delayed-ekf", p0=1e-4, guard=True).warnings == ()


def test_ticks_are_timed_by_the_clock_given():
    ticking = iter(range(0, 10**9, 1000))
    report = run("popf", 1e-4, clock=lambda: next(ticking))
    assert report.tick_p50_s == report.tick_p99_s == report.tick_longest_s == pytest.approx(1e-6)
    assert run("popf", 1e-4).tick_p50_s is None


def test_an_emergency_stop_is_noticed_however_much_the_robot_has_said():
    warnings = Warnings()
    for number in range(2 * MOST_TOLD):
        warnings.hear(Statustext(MAV_SEVERITY_ERROR, f"text {number}".encode()), number)
    assert len(warnings.texts) == MOST_TOLD
    assert warnings.emergency_tick is None
    for tick in (100, 200):
        warnings.hear(Statustext(MAV_SEVERITY_EMERGENCY, b"emergency stop"), tick)
    assert warnings.emergency_tick == 100


def test_the_warning_is_about_the_latest_of_the_measurements_of_a_tick():
    popf = ESTIMATORS["popf"].make(RobotModel())
    state = popf.start(np.zeros(3), np.eye(3) * 3e-3)
    for _ in range(LATE):
        state = popf.predict(state, np.array((0.5, 0.3)))
    state = popf.correct(state, [Measured(0, np.zeros(3)), Measured(LATE, state.x)])
    assert f"a delay of {LATE} ticks" in popf.warning(state)
