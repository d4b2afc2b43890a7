"""What the robot did while nobody heard it becomes known when the link is back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import laglab
from laglab.results.numbers import deviation, loop_estimates
from laglab.runs.inline import InlineLink
from laglab.runs.robot_side import Setup, open_robot
from laglab.runs.station_side import make_station
from laglab.scenario import Scenario
from laglab_control.flight import STOOD
from laglab_gateway import MemoryRecorder, Surroundings, Trace, TraceRow, trace_of
from laglab_gateway.services import Arming
from laglab_protocol import Listener, Receiver, Sender

SOON = 20
"""Ticks beyond n + m within which all is known again."""


def error_after(run: laglab.Run, quiet: int) -> float:
    """The largest error of the estimate [m, rad] from n + m + SOON ticks after the first
    measurement that crosses at or after tick `quiet`, when the link is ideal again."""
    link = run.scenario.link
    n, m = link.command_delay, link.measurement_delay
    known = quiet + m + n + m + SOON
    off = deviation(run.trace, loop_estimates(run.trace))[known:]
    assert len(off) > 20, "the run goes on for a while"
    return float(np.nanmax(np.abs(off)))


@st.composite
def bad_times(draw: st.DrawFn) -> tuple[list[dict[str, object]], float]:
    """Stretches in which much or all is lost, either way or both; and when the last one is over."""
    events, time = [], 0.3
    for _ in range(draw(st.integers(1, 4))):
        duration = draw(st.sampled_from([0.02, 0.1, 0.4, 1.2]))
        direction = draw(st.sampled_from(["command", "measurement", "both"]))
        loss = draw(st.sampled_from([0.3, 0.9, 1.0]))
        events.append(
            {"at": time, "duration": duration, "direction": direction, "link": {"loss": loss}}
        )
        time += duration + draw(st.sampled_from([0.03, 0.25, 0.6]))
    return events, time


@pytest.mark.slow
@settings(max_examples=25)
@given(
    times=bad_times(),
    delays=st.tuples(st.integers(0, 20), st.integers(0, 25)),
    seed=st.integers(0, 10**6),
    estimator=st.sampled_from(["delayed-ekf", "popf"]),
)
def test_whatever_was_lost_the_estimate_is_the_pose_again(
    times: tuple[list[dict[str, object]], float],
    delays: tuple[int, int],
    seed: int,
    estimator: str,
) -> None:
    events, over = times
    n, m = delays
    run = laglab.run(
        "fig6",
        {
            "estimator.kind": estimator,
            "law.v_max": 1.0,
            "law.omega_max": 1.7,
            "link.command_delay": n,
            "link.measurement_delay": m,
            "link.event": events,
            "seed": seed,
            "duration": over + (2 * m + n + SOON + 60) / 100,
        },
    )
    assert error_after(run, round(over * 100)) < 1e-6


@pytest.mark.parametrize("silent", [100, 900])
def test_however_long_nobody_was_heard(silent: int) -> None:
    """Up to the 1024 ticks that both sides remember; the robot has come to a standstill."""
    event = {"at": 1.0, "duration": silent / 100, "link": {"loss": 1.0}}
    overrides = {"estimator.kind": "delayed-ekf", "link.event": [event], "law.v_max": 1.0}
    run = laglab.run("fig6", overrides | {"law.omega_max": 1.7, "duration": 3.0 + silent / 100})
    assert error_after(run, 100 + silent) < 1e-6
    assert run.summary.link is not None
    assert run.summary.link.stops == 1


KNOWN = STOOD + 3
"""So many ticks beyond n at rest a robot that was to drive is taken not to obey."""


@pytest.mark.parametrize("limit", ["v_limit", "omega_limit"])
@pytest.mark.parametrize("estimator", ["delayed-ekf", "popf"])
def test_a_robot_that_refuses_all_it_is_sent_is_where_it_is(limit: str, estimator: str) -> None:
    """It echoes in time that nothing came into force: then nothing on its way does, either."""
    overrides = {"estimator.kind": estimator, "duration": 3.0, f"safety.{limit}": 0.2}
    run = laglab.run("fig6", overrides | {"law.v_max": 1.0, "law.omega_max": 1.7})
    off = np.abs(deviation(run.trace, loop_estimates(run.trace)))
    n, m = run.scenario.link.command_delay, run.scenario.link.measurement_delay
    assert off[n + m + 20].max() > 0.02, "it might have driven"
    assert off[n + m + KNOWN :].max() < 1e-6
    assert any("stands still, whatever it is sent" in each for each in run.summary.warnings)
    assert any("beyond V_MAX, OMEGA_MAX" in each for each in run.summary.warnings)


def test_what_is_sent_in_vain_for_long_moves_nothing() -> None:
    """Only commands are lost: the station hears that the robot has stopped by itself."""
    lost = {"at": 1.0, "duration": 3.0, "direction": "command", "link": {"loss": 1.0}}
    overrides = {"estimator.kind": "delayed-ekf", "link.event": [lost], "law.v_max": 1.0}
    run = laglab.run("fig6", overrides | {"law.omega_max": 1.7, "duration": 6.0})
    n, m = run.scenario.link.command_delay, run.scenario.link.measurement_delay
    off = np.abs(deviation(run.trace, loop_estimates(run.trace))).max(axis=1)
    stopped = 100 + n + 100  # the failsafe's time and its ramp
    assert off[stopped : stopped + n + KNOWN].max() > 0.05
    assert off[stopped + n + m + KNOWN : 400 + n].max() < 1e-6
    assert off[400 + n + m + SOON :].max() < 1e-6


def test_a_robot_that_stood_may_drive_again_when_nobody_tells() -> None:
    """It gets commands again while its measurements are lost: to go on believing that it stands
    would lead it ever further away."""
    down = [("command", 1.0, 1.8), ("both", 2.8, 0.2), ("measurement", 3.0, 2.0)]
    events = [
        {"at": at, "duration": duration, "direction": direction, "link": {"loss": 1.0}}
        for direction, at, duration in down
    ]
    overrides = {"estimator.kind": "delayed-ekf", "link.event": events, "law.v_max": 1.0}
    run = laglab.run("fig6", overrides | {"law.omega_max": 1.7, "duration": 8.0})
    off = np.abs(deviation(run.trace, loop_estimates(run.trace))).max(axis=1)
    assert off.max() < 0.5
    assert error_after(run, 500) < 1e-6
    assert run.summary.converged


@pytest.mark.parametrize("n", [30, 60])
def test_a_robot_that_waits_for_what_is_on_its_way_obeys(n: int) -> None:
    """After an outage both ways it rests until the first new command has crossed."""
    lost = {"at": 1.0, "duration": 2.0, "link": {"loss": 1.0}}
    run = laglab.run("lab", {"link.command_delay": n, "link.event": [lost], "duration": 6.0})
    assert not any("stands still" in each for each in run.summary.warnings)


class Hand(MemoryRecorder):
    """Somebody near the robot, who disarms it in the middle of an outage, and arms it again."""

    def __init__(self, arming: Arming, off: int, on: int) -> None:
        super().__init__()
        self._arming, self._off, self._on = arming, off, on

    def row(self, row: TraceRow) -> None:
        super().row(row)
        if row.tick == self._off:
            self._arming.disarm()
        if row.tick == self._on:
            self._arming.arm()


def handled(scenario: Scenario, off: int, on: int) -> Trace:
    """A run in which somebody disarms the robot at one tick, and arms it at another."""
    with open_robot(scenario, Setup()) as robot:
        hand = Hand(robot.services.arming, off, on)
        link = InlineLink(make_station(scenario, Sender(200, 190)), Receiver())
        robot.serve(Surroundings(Listener(link, robot.codec.receiver), hand))
    return trace_of(hand.rows)


@pytest.mark.parametrize("estimator", ["delayed-ekf", "popf"])
@pytest.mark.parametrize("guard", [False, True])
def test_a_robot_that_stays_disarmed_stands(estimator: str, guard: bool) -> None:
    """As one that was stopped for good."""
    overrides = {"estimator.kind": estimator, "estimator.guard": guard, "law.v_max": 1.0}
    scenario = laglab.load("fig6", overrides | {"law.omega_max": 1.7, "duration": 5.0})
    n, m = scenario.link.command_delay, scenario.link.measurement_delay
    trace = handled(scenario, 115, 315)
    off = np.abs(deviation(trace, loop_estimates(trace))).max(axis=1)
    assert off[115 + n + m + KNOWN : 315].max() < 1e-6
    assert off[315 + m].max() > 0.05, "nobody has told yet that it drives again"
    assert off[315 + n + m + SOON :].max() < 1e-6


def test_a_robot_that_was_disarmed_meanwhile_tells_so() -> None:
    event = {"at": 1.0, "duration": 0.4, "direction": "measurement", "link": {"loss": 1.0}}
    overrides = {"estimator.kind": "delayed-ekf", "link.event": [event], "law.v_max": 1.0}
    trace = handled(laglab.load("fig6", overrides | {"duration": 2.5}), 110, 125)
    assert (trace["v"][112:125] == 0).all()
    assert (trace["v"][[110, 127]] > 0.5).all()
    off = deviation(trace, loop_estimates(trace))
    assert np.abs(off[140 + 20 : 150 + 20]).max() > 1e-3, "it takes a while to be told"
    assert np.abs(off[140 + 20 + 30 + SOON :]).max() < 1e-6
