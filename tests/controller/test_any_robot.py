"""Whatever a robot says, the station answers or passes over: no exception, no growth, no hang."""

import cProfile
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import astuple

from laglab_control import ESTIMATORS, StationConfig
from laglab_protocol import (
    Command,
    End,
    Measurement,
    Message,
    Sender,
    Tick,
    Timesync,
    frames_in,
)
from laglab_station import Station
from laglab_station.hearing import Coming

NUMBERS = st.floats() | st.floats(-10, 10)
TICKS = st.integers(0, 2**32 - 1) | st.integers(0, 30)
MESSAGES = st.one_of(
    st.builds(
        Measurement, *[NUMBERS] * 5, TICKS, st.integers(-(2**31), 2**31 - 1) | st.integers(-1, 30)
    ),
    st.builds(Tick, TICKS, st.integers(0, 3)),
    st.builds(End, TICKS, st.integers(0, 255)),
    st.builds(Timesync, st.just(0), st.integers(0, 2**62)),
)


@pytest.mark.parametrize("estimator", ESTIMATORS)
@settings(max_examples=60)
@given(said=st.lists(MESSAGES, max_size=40))
def test_no_message_of_the_robot_harms_the_station(estimator: str, said: list[Message]) -> None:
    station, robot = Station(StationConfig(estimator=estimator), clock=lambda: 0), Sender(1, 1)
    for message in said:
        answered = frames_in(b"".join(station.hear(frames_in(robot.frame(message)))))
        for frame in answered:
            if isinstance(frame.message, Command):
                assert math.isfinite(frame.message.v)
                assert math.isfinite(frame.message.omega)
        station.look_ahead()
    station.hear_backlog(frames_in(b"".join(map(robot.frame, said))))
    station.report()


@pytest.mark.parametrize("estimator", ["popf", "delayed-ekf", "raw"])
def test_a_robot_far_ahead_is_met_anew(estimator: str) -> None:
    """Nobody knows what it did meanwhile: it is told to stand still until its pose is known."""
    station, robot = Station(StationConfig(estimator=estimator)), Sender(1, 1)
    station.hear(frames_in(robot.frame(Tick(0, 0))))
    (frame,) = frames_in(b"".join(station.hear(frames_in(robot.frame(Tick(4 * 10**9, 0))))))
    assert astuple(frame.message)[:3] == (0.0, 0.0, 4 * 10**9)


def test_measurements_without_a_tick_are_forgotten() -> None:
    coming = Coming()
    for k in range(5000):
        coming.hear(Measurement(*np.zeros(5), k, -1))
    assert len(coming.take().measurements) < 300


N = 2
RNG = np.random.default_rng(3)
LATE = {k: RNG.integers(12, size=1 + k % 3).tolist() if 30 <= k < 80 else [5] for k in range(1400)}
"""How late the measurements are that come at tick k: always the same, then never as expected."""


def messages_at(k: int, sent: dict[int, Command]) -> list[Message]:
    """A robot that hardly moves says truthfully which command was in force."""
    measurements = []
    for s in [k - late for late in LATE[k] if late <= k]:
        made = sent.get(s - 1 - N)
        u = made.speeds if made else (0.0, 0.0)
        measurements.append(Measurement(0.1, 0.001 * s, 0.0, *u, s, made.tick if made else -1))
    return [*measurements, Tick(k, len(measurements))]


@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_looking_ahead_changes_no_answer(estimator: str) -> None:
    """Neither what comes unexpectedly, nor a repeat, nor meeting the robot anew."""
    config = StationConfig(estimator=estimator, command_delay=N)
    ahead, without = Station(config), Station(config)
    robot, sent = Sender(1, 1), dict[int, Command]()
    for k in (*range(80), *range(1200, 1400)):
        data = b"".join(map(robot.frame, messages_at(k, sent)))
        for _ in range(1 + (k % 11 == 0)):
            answer = ahead.hear(frames_in(data))
            assert answer == without.hear(frames_in(data))
            ahead.look_ahead()
        *_, command = [frame.message for frame in frames_in(b"".join(answer))]
        sent[k] = command
    assert ahead.tick == 1399
    assert ahead.outcome is None
    assert ahead.report() == without.report()


def test_a_warning_is_not_lost_when_the_robot_is_met_anew() -> None:
    station, robot = Station(StationConfig(initial_covariance=np.eye(3) * 10)), Sender(1, 1)
    for k in range(6):
        late = [Measurement(*[0.0] * 5, 0, -1)] if k == 5 else []
        station.hear(frames_in(b"".join(map(robot.frame, [*late, Tick(k, len(late))]))))
    station.hear(frames_in(robot.frame(Tick(2000, 0))))
    assert "tick 5: popf's gain is" in station.warnings[0]


def test_nothing_heard_after_the_end_is_of_any_account() -> None:
    station, robot = Station(StationConfig()), Sender(1, 1)
    for message in (Tick(0, 0), Tick(1, 0), End(1, 0), Tick(5000, 0)):
        station.hear(frames_in(robot.frame(message)))
    assert station.tick == 1


def test_waiting_for_measurements_that_do_not_come_costs_no_more_from_tick_to_tick() -> None:
    """Counted in calls of the model, not in seconds."""
    station, robot = Station(StationConfig()), Sender(1, 1)
    calls = []
    for k in range(600):
        late = [Measurement(*[0.0] * 5, k - 5, -1)] if 5 <= k < 100 else []
        data = b"".join(map(robot.frame, [*late, Tick(k, len(late))]))
        with cProfile.Profile() as profile:
            station.hear(frames_in(data))
            station.look_ahead()
        calls.append(sum(entry.callcount for entry in profile.getstats()))
    assert max(calls[110:]) <= max(calls[50:100])
