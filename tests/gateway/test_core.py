"""The gateway's core against a station made of the codec alone, around the real FMU."""

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import Gateway, GatewayConfig, Outcome
from laglab_protocol import (
    MAV_SEVERITY_WARNING,
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Applied,
    Command,
    End,
    EndReason,
    Estimate,
    Measurement,
    Message,
    Recall,
    Receiver,
    Sender,
    Statustext,
    Tick,
    frames_in,
)

PARAMETERS = RobotParameters(start=(-3.0, -3.0, 0.0), noise=True, seed=5)
LAST_TICK = 30


@pytest.fixture(scope="module")
def robot() -> Iterator[Robot]:
    with Robot.open(3, PARAMETERS) as opened:
        yield opened


def gateway_of(robot: Robot, n: int, m: int, last_tick: int = LAST_TICK) -> Gateway:
    robot.reset(PARAMETERS)
    plant = FmuPlant(robot, PARAMETERS)
    return Gateway(plant, GatewayConfig(n, m, last_tick, PARAMETERS.sample_time))


class Station:
    """Says what the test says."""

    def __init__(self, system: int = STATION_SYSTEM) -> None:
        self._sender = Sender(system, STATION_COMPONENT)

    def say(self, *messages: Message) -> bytes:
        return b"".join(self._sender.frame(message) for message in messages)


def command(tick: int, v: float = 0.0, estimates: int = 0) -> Command:
    return Command(v, v / 2, tick, ROBOT_SYSTEM, ROBOT_COMPONENT, estimates)


def heard(frames: list[bytes]) -> list[Message]:
    return [frame.message for frame in Receiver().receive(b"".join(frames))]


@settings(max_examples=60)
@given(n=st.integers(0, 35), m=st.integers(0, 35))
def test_both_delays_are_exact(robot: Robot, n: int, m: int) -> None:
    gateway, station = gateway_of(robot, n, m), Station()
    rows = []
    while gateway.outcome is None:
        k = gateway.tick
        *measurements, tick = heard(gateway.open_tick())
        assert tick == Tick(k, len(measurements))
        if k < m:
            assert not measurements
        else:
            s = k - m
            sample = rows[s] if m else None
            (z,) = measurements
            assert isinstance(z, Measurement)
            assert z.tick == s
            assert z.command_tick == (s - 1 - n if s - 1 - n >= 0 else NO_COMMAND)
            if sample:
                assert z.pose == (sample.x_meas, sample.y_meas, sample.theta_meas)
            if s:
                assert (z.v, z.omega) == (rows[s - 1].v, rows[s - 1].omega)
        gateway.hear(frames_in(station.say(command(k, v=0.1 + k))))
        gateway.settle()
        rows.append(gateway.close_tick())
    assert gateway.outcome == Outcome(EndReason.COMPLETED, LAST_TICK)
    for k, row in enumerate(rows):
        assert row.tick == k
        assert row.v == (rows[k - n].v_sent if k >= n else 0.0)


def test_a_repeated_tick_brings_the_same_messages_in_new_frames(robot: Robot) -> None:
    gateway = gateway_of(robot, 0, 0)
    first, again = gateway.open_tick(), gateway.repeat_tick()
    assert heard(first) == heard(again)
    assert first != again


def test_only_the_stations_command_for_this_tick_answers_it(robot: Robot) -> None:
    gateway, station = gateway_of(robot, 0, 0), Station()
    gateway.open_tick()
    gateway.hear(frames_in(station.say(command(7))))
    gateway.hear(frames_in(Station(system=42).say(command(0))))
    gateway.hear(frames_in(station.say(replace(command(0), target_system=2))))
    gateway.hear(frames_in(station.say(replace(command(0), target_component=2))))
    gateway.hear(frames_in(b"\xfd\x12 no frame at all"))
    assert not gateway.answered
    gateway.hear(frames_in(station.say(command(0))))
    assert gateway.answered


def test_an_answer_that_lost_its_estimate_waits_for_the_repeat(robot: Robot) -> None:
    gateway, station = gateway_of(robot, 0, 0), Station()
    gateway.open_tick()
    estimate = Estimate(1.0, 2.0, 3.0, *[0.0] * 6, 0)
    gateway.hear(frames_in(station.say(command(0, estimates=1))))
    assert not gateway.answered
    gateway.hear(frames_in(station.say(estimate, command(0, estimates=1))))
    assert gateway.answered
    gateway.settle()
    assert gateway.close_tick()[8:11] == (1.0, 2.0, 3.0)


@pytest.mark.parametrize("late", [0, 1, 3])
def test_a_question_is_answered_however_late_the_answer_it_came_with(
    robot: Robot, late: int
) -> None:
    gateway, station = gateway_of(robot, 0, 0), Station()
    told: list[Message] = []
    for tick in range(8):
        told += heard(gateway.open_tick())
        if tick == 2 + late:
            question = Recall(0, 2, ROBOT_SYSTEM, ROBOT_COMPONENT)
            gateway.hear(frames_in(station.say(question, command(2, estimates=1))))
        gateway.settle()
        gateway.close_tick()
    (answer,) = [each for each in told if isinstance(each, Applied)]
    assert (answer.first, answer.count) == (0, 2)


def test_the_last_tick_is_not_stepped(robot: Robot) -> None:
    gateway, station = gateway_of(robot, 0, 0, last_tick=0), Station()
    before = robot.read()
    gateway.open_tick()
    gateway.hear(frames_in(station.say(command(0, v=1.0))))
    gateway.settle()
    gateway.close_tick()
    assert gateway.outcome == Outcome(EndReason.COMPLETED, 0)
    assert robot.read() == before


def test_an_end_of_a_tick_before_the_last_answer_ends_nothing(robot: Robot) -> None:
    """It is of a run that is past."""
    gateway, station = gateway_of(robot, 0, 0), Station()
    for tick in range(6):
        gateway.open_tick()
        gateway.hear(frames_in(station.say(command(tick))))
        if tick == 5:
            gateway.hear(frames_in(station.say(End(3, EndReason.COMPLETED))))
        gateway.settle()
        gateway.close_tick()
    assert gateway.outcome is None
    gateway.open_tick()
    gateway.hear(frames_in(station.say(End(5, EndReason.COMPLETED))))
    gateway.close_tick()
    assert gateway.outcome == Outcome(EndReason.COMPLETED, 6)


def test_what_a_repeated_answer_says_again_is_told_once(robot: Robot) -> None:
    gateway, station = gateway_of(robot, 0, 0), Station()
    gateway.open_tick()
    text = Statustext(MAV_SEVERITY_WARNING, b"estimate is wrong")
    for _ in range(3):
        gateway.hear(frames_in(station.say(text, command(0))))
    assert gateway.take_notices() == [text]


def test_the_stations_end_ends_the_run_at_this_tick(robot: Robot) -> None:
    gateway, station = gateway_of(robot, 0, 0), Station()
    gateway.open_tick()
    gateway.hear(frames_in(station.say(End(0, EndReason.DIVERGED), command(0))))
    gateway.close_tick()
    assert gateway.outcome == Outcome(EndReason.DIVERGED, 0)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_command_that_is_not_finite_moves_nothing(robot: Robot, value: float) -> None:
    gateway, station = gateway_of(robot, 0, 0), Station()
    gateway.open_tick()
    gateway.hear(frames_in(station.say(command(0, v=value))))
    gateway.settle()
    row = gateway.close_tick()
    assert (row.v, row.omega) == (0.0, 0.0)
    assert gateway.audit.report().refused == {"not finite": 1}


def test_why_it_stops_is_what_was_wrong_since_the_last_command_it_followed(robot: Robot) -> None:
    gateway, station = gateway_of(robot, 0, 0, last_tick=200), Station()
    for tick in range(80):
        gateway.open_tick()
        if tick < 3:
            v = float("nan") if tick == 1 else 0.1
            gateway.hear(frames_in(station.say(command(tick, v))))
        gateway.settle()
        gateway.close_tick()
    (notice,) = gateway.take_notices()
    assert notice.text == b"no fresh command for 0.5 s: stopping"
