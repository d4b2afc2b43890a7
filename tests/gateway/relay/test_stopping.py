"""What a robot behind a relay must not get, and how it is stopped."""

import pytest

from laglab_gateway import Safety
from laglab_protocol import Command, CommandAck, CommandLong, Message, Planned
from laglab_protocol.dialect.generated import laglab as mavlink

from .rig import Rig, Robot, relay


def test_why_the_robot_stops_is_said_when_it_stops_and_once() -> None:
    rig = Rig(relay(safety=Safety(v_limit=1.0)))
    rig.run(10)
    for bad in (True, False, True, False):
        rig.feed(rig.robot.tick())
        tick = rig.relay.tick
        rig.say(Command(5.0 if bad else 0.1, 0.0, tick, 1, 1, 0))
        rig.forward()
    assert rig.relay.take_notices() == [], "one command that is refused stops nothing"
    for _ in range(120):
        rig.feed(rig.robot.tick())
        rig.say(Command(5.0, 0.0, rig.relay.tick, 1, 1, 0))
        rig.forward()
    (notice,) = rig.relay.take_notices()
    assert notice.text == b"commands are beyond V_MAX, OMEGA_MAX: stopping"


def refused(rig: Rig, ticks: int, *speeds: float) -> list[bytes]:
    """What is said while only such commands come, in turn."""
    for number in range(ticks):
        rig.feed(rig.robot.tick())
        rig.say(Command(speeds[number % len(speeds)], 0.0, rig.relay.tick, 1, 1, 0))
        rig.forward()
    return [notice.text for notice in rig.relay.take_notices()]


def test_each_reason_is_said_once_however_they_take_turns() -> None:
    rig = Rig(relay(safety=Safety(v_limit=1.0)))
    rig.run(5)
    assert sorted(refused(rig, 120, 5.0, float("nan"))) == [
        b"commands are beyond V_MAX, OMEGA_MAX: stopping",
        b"commands are not finite: stopping",
    ]


def test_of_a_robot_that_has_begun_again_it_is_said_anew() -> None:
    rig = Rig(relay(safety=Safety(v_limit=1.0)))
    rig.run(5)
    (first,) = refused(rig, 80, 5.0)
    rig.robot = Robot()
    assert refused(rig, 120, 5.0)[-1] == first


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        ((float("nan"), 0.0), "not finite"),
        ((0.0, float("inf")), "not finite"),
        ((3.0, 0.0), "out of limits"),
    ],
)
def test_what_a_robot_must_not_get_is_refused_and_counted(
    bad: tuple[float, float], why: str
) -> None:
    rig = Rig(relay(safety=Safety(v_limit=2.0)))
    rig.feed(rig.robot.tick())
    rig.say(Command(*bad, 0, 1, 1, 0))
    assert rig.forward() == []
    assert rig.relay.audit.report().refused == {why: 1}


def test_an_emergency_stop_stops_a_real_robot_for_good() -> None:
    rig = Rig(relay())
    rig.run(5)
    rig.say(CommandLong(1.0, *[0.0] * 6, mavlink.MAV_CMD_DO_FLIGHTTERMINATION, 1, 1, 0))
    rig.run(5)
    assert [row.v for row in rig.rows[-3:]] == [0.0, 0.0, 0.0]
    (ack,) = rig.say(CommandLong(*[0.0] * 7, mavlink.MAV_CMD_LAGLAB_RESET_POSE, 1, 1, 0))
    assert isinstance(ack, CommandAck)
    assert ack.result == mavlink.MAV_RESULT_TEMPORARILY_REJECTED
    assert rig.relay.services.arming.stopped


def planned(tick: int, length: int) -> list[Message]:
    following = tuple((i / 1000, 0.0) for i in range(length))
    plan = Planned(Command(1.0, 0.0, tick, 1, 1, 0, length), tick + 2, following)
    return [*plan.frames(), plan.command]


def test_a_plan_is_passed_on_whole_when_its_command_is_due() -> None:
    rig = Rig(relay(n=2))
    rig.feed(rig.robot.tick())
    said = planned(0, 20)
    rig.say(*said)
    assert rig.forward() == []
    rig.feed(rig.robot.tick())
    assert rig.forward() == said
    assert rig.forward() == []


def test_a_robot_that_is_stopped_does_not_go_on_by_its_plan_though_no_command_comes() -> None:
    rig = Rig(relay(n=2))
    rig.feed(rig.robot.tick())
    rig.say(*planned(0, 200))
    rig.feed(rig.robot.tick())
    assert len(rig.forward()) == 15
    rig.say(CommandLong(1.0, *[0.0] * 6, mavlink.MAV_CMD_DO_FLIGHTTERMINATION, 1, 1, 0))
    assert rig.forward() == [Command(0.0, 0.0, 1, 1, 1, 0)]
    rig.feed(rig.robot.tick())
    assert rig.forward() == []
    rig.say(*planned(2, 20))
    rig.feed(rig.robot.tick())
    assert rig.forward() == [Command(0.0, 0.0, 2, 1, 1, 0)]
