"""Whatever a robot says, the station answers or passes over: no exception, no growth, no hang."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_controller import ESTIMATORS, Station, StationConfig
from laglab_protocol import Command, End, Measurement, Message, Receiver, Sender, Tick, Timesync

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
@settings(max_examples=60, deadline=2000)
@given(said=st.lists(MESSAGES, max_size=40))
def test_no_message_of_the_robot_harms_the_station(estimator: str, said: list[Message]) -> None:
    station, robot = Station(StationConfig(estimator=estimator), clock=lambda: 0), Sender(1, 1)
    for message in said:
        answered = Receiver().receive(station.receive(robot.frame(message), datagram=True))
        for frame in answered:
            if isinstance(frame.message, Command):
                assert math.isfinite(frame.message.v)
                assert math.isfinite(frame.message.omega)
        station.look_ahead()
    station.report()


@pytest.mark.parametrize("estimator", ["popf", "delayed-ekf", "raw"])
def test_a_robot_far_ahead_is_met_anew(estimator: str) -> None:
    """Nobody knows what it did meanwhile: it is told to stand still until its pose is known."""
    station, robot = Station(StationConfig(estimator=estimator)), Sender(1, 1)
    station.receive(robot.frame(Tick(0, 0)), datagram=True)
    (frame,) = Receiver().receive(station.receive(robot.frame(Tick(4 * 10**9, 0)), datagram=True))
    assert frame.message[:3] == (0.0, 0.0, 4 * 10**9)


def test_measurements_without_a_tick_are_forgotten() -> None:
    station, robot = Station(StationConfig()), Sender(1, 1)
    for k in range(5000):
        station.receive(robot.frame(Measurement(*np.zeros(5), k, -1)), datagram=True)
    assert len(station._measurements) < 300
