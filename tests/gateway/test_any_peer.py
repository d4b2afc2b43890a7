"""Whatever a station or a real robot says, the robot's side goes on: no exception, no growth."""

import math
from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import Gateway, GatewayConfig, Relay, Services, standard_parameters
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    CommandLong,
    Estimate,
    Measurement,
    Message,
    Receiver,
    Sender,
    Tick,
    frames_in,
)
from laglab_protocol.messages.layout import LAYOUT_OF_ID, Layout

PARAMETERS = RobotParameters(noise=True)
CONFIG = GatewayConfig(2, 3, 10**6, PARAMETERS.sample_time)
OURS = [layout for layout in LAYOUT_OF_ID.values() if layout.name.startswith("LAGLAB_")]
ASKED = [LAYOUT_OF_ID[number] for number in (0, 4, 20, 21, 23, 75, 76, 111)]
"""What ground stations ask for: heartbeat, ping, parameters, commands, timesync."""


def any_of(layout: Layout) -> st.SearchStrategy[Message]:
    """Any payload: fields of any value, not a number among them."""
    payloads = st.binary(min_size=layout.size, max_size=layout.size)
    return payloads.map(lambda payload: layout.type(*layout.unpack(payload, 0)))


MESSAGES = st.sampled_from(OURS + ASKED).flatmap(any_of)
COMMANDS = st.builds(
    Command, st.floats(-9, 9), st.floats(), st.integers(0, 30), st.just(1), st.just(1), st.just(0)
)
REQUESTS = st.builds(
    CommandLong,
    *[st.sampled_from([0.0, 1.0, 3e38, math.nan]) | st.floats(width=32)] * 7,
    st.sampled_from([400, 185, 512, 511, 520, 52100]),
    st.just(ROBOT_SYSTEM),
    st.just(ROBOT_COMPONENT),
    st.just(0),
)
TICKS = st.builds(Tick, st.integers(0, 60), st.just(0))


@pytest.fixture(scope="module")
def robot() -> Iterator[Robot]:
    with Robot.open(3, PARAMETERS) as opened:
        yield opened


@settings(max_examples=100)
@given(said=st.lists(MESSAGES | COMMANDS | REQUESTS, max_size=30))
def test_no_message_of_a_station_harms_the_robots_side(robot: Robot, said: list[Message]) -> None:
    robot.reset(PARAMETERS)
    gateway = Gateway(FmuPlant(robot, PARAMETERS), CONFIG)
    station = Sender(STATION_SYSTEM, STATION_COMPONENT)
    for message in said:
        gateway.open_tick()
        gateway.settle()
        gateway.hear(frames_in(station.frame(message)))
        gateway.take_notices()
        row = gateway.close_tick()
        assert math.isfinite(row.x or 0.0)
        if gateway.outcome is not None:
            return


@settings(max_examples=100)
@given(said=st.lists(MESSAGES | COMMANDS | REQUESTS | TICKS, max_size=30))
def test_no_message_of_either_side_harms_the_relay(said: list[Message]) -> None:
    relay = Relay(CONFIG, Services(standard_parameters(2, 3, CONFIG.safety), placeable=False))
    robot = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
    station = Sender(STATION_SYSTEM, STATION_COMPONENT)
    for message in said:
        relay.hear(frames_in(station.frame(message)))
        for frame in frames_in(robot.frame(message)):
            if relay.hear_robot(frame):
                if relay.under_way:
                    relay.close_tick()
                relay.open_tick()
        for frame in Receiver().receive(b"".join(relay.forward())):
            assert isinstance(frame.message, Command)
            assert all(map(math.isfinite, frame.message.speeds))
        relay.take_notices()


def test_what_no_tick_closes_does_not_pile_up(robot: Robot) -> None:
    robot.reset(PARAMETERS)
    gateway = Gateway(FmuPlant(robot, PARAMETERS), CONFIG)
    relay = Relay(CONFIG, Services(standard_parameters(2, 3, CONFIG.safety), placeable=False))
    for _ in range(5000):
        frame = Sender(STATION_SYSTEM, STATION_COMPONENT).frame(Estimate(*[0.0] * 9, tick=0))
        gateway.hear(frames_in(frame))
        frame = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT).frame(Measurement(*[0.0] * 5, 0, -1))
        for each in frames_in(frame):
            relay.hear_robot(each)
    assert len(gateway._answer.estimates) < 300
    assert len(relay._coming) < 300
