"""Services in the gateway: on the loop's own link, and for those who only watch."""

import math
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Safety,
    Services,
    Watch,
    Watcher,
    standard_parameters,
)
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Codec,
    Command,
    CommandAck,
    CommandLong,
    Endpoint,
    Heartbeat,
    Listener,
    LocalPositionNed,
    Message,
    ParamRequestRead,
    ParamSet,
    ParamValue,
    Receiver,
    Sender,
    frames_in,
    open_endpoint,
)
from laglab_protocol.dialect.generated import laglab as mavlink
from laglab_protocol.endpoints import tty

PARAMETERS = RobotParameters(start=(-3.0, -2.0, 0.0), noise=False)
SAMPLE_TIME = PARAMETERS.sample_time


@pytest.fixture(scope="module")
def robot() -> Iterator[Robot]:
    with Robot.open(3, PARAMETERS) as opened:
        yield opened


def gateway_of(robot: Robot, armed: bool = True) -> Gateway:
    robot.reset(PARAMETERS)
    services = Services(standard_parameters(0, 0, Safety()), armed)
    config = GatewayConfig(0, 0, 10**6, SAMPLE_TIME)
    return Gateway(FmuPlant(robot, PARAMETERS), config, services=services)


def station() -> Sender:
    return Sender(STATION_SYSTEM, STATION_COMPONENT)


def drive(gateway: Gateway, sender: Sender, v: float = 1.0) -> float:
    """One tick in which the station commands v; the distance covered [m]."""
    x = gateway.state.x
    gateway.open_tick()
    gateway.hear(frames_in(sender.frame(Command(v, 0.0, gateway.tick, 1, 1, 0))))
    gateway.settle()
    gateway.close_tick()
    return gateway.state.x - x


def request(number: int, *numbers: float) -> CommandLong:
    return CommandLong(*numbers, *[0.0] * (7 - len(numbers)), number, 1, 1, 0)


def told(gateway: Gateway, asked: bytes) -> list[Message]:
    return [frame.message for frame in frames_in(b"".join(gateway.hear(frames_in(asked))))]


def test_requests_are_answered_on_the_loops_link(robot: Robot) -> None:
    gateway, sender = gateway_of(robot), Sender(255, 190)
    (value,) = told(gateway, sender.frame(ParamRequestRead(0, 1, 1, b"")))
    (ack,) = told(gateway, sender.frame(request(400, 0.0)))

    assert isinstance(value, ParamValue)
    assert value.param_id == b"DELAY_N"
    assert isinstance(ack, CommandAck)
    assert ack.result == mavlink.MAV_RESULT_ACCEPTED


def test_only_the_station_drives(robot: Robot) -> None:
    gateway = gateway_of(robot)
    gateway.open_tick()
    for system, component in [(255, 190), (200, 1), (1, 1), (201, 190)]:
        other = Sender(system, component)
        gateway.hear(frames_in(other.frame(Command(1.0, 0.0, 0, 1, 1, 0))))

    assert not gateway.answered


def test_disarmed_the_robot_stands_still(robot: Robot) -> None:
    gateway, sender = gateway_of(robot, armed=False), station()
    assert drive(gateway, sender) == 0.0

    gateway.hear(frames_in(sender.frame(request(400, 1.0))))
    assert drive(gateway, sender) == pytest.approx(SAMPLE_TIME)


def test_an_emergency_stop_stops_within_a_tick(robot: Robot) -> None:
    gateway, sender = gateway_of(robot), station()
    assert drive(gateway, sender) > 0.0

    gateway.hear(frames_in(Sender(255, 190).frame(request(185, 1.0))))
    assert drive(gateway, sender) == 0.0


def test_a_limit_set_holds_from_the_next_command_on(robot: Robot) -> None:
    gateway, sender = gateway_of(robot), station()
    assert drive(gateway, sender, 2.0) == pytest.approx(2.0 * SAMPLE_TIME)

    gateway.hear(frames_in(sender.frame(ParamSet(1.0, 1, 1, b"V_MAX", 9))))
    assert drive(gateway, sender, 3.0) == pytest.approx(2.0 * SAMPLE_TIME), "the last one holds"
    assert sum(gateway.audit.refused.values()) == 1


def test_the_pose_is_reset(robot: Robot) -> None:
    gateway, sender = gateway_of(robot, armed=False), station()
    reset = request(mavlink.MAV_CMD_LAGLAB_RESET_POSE, 5.0, math.nan, 0.5)
    gateway.hear(frames_in(sender.frame(reset)))
    drive(gateway, sender)

    assert (gateway.state.x, gateway.state.y, gateway.state.theta) == (5.0, -2.0, 0.5)


def watcher(endpoint: Endpoint) -> Watcher:
    sender, receiver = Codec(ROBOT_SYSTEM, ROBOT_COMPONENT).on_another_link()
    return Watcher(Listener(endpoint, receiver), sender)


def test_a_watcher_sees_and_asks_but_does_not_drive(robot: Robot, stack: ExitStack) -> None:
    gateway = gateway_of(robot)
    ours = stack.enter_context(open_endpoint("udpin://127.0.0.1:0"))
    theirs = stack.enter_context(open_endpoint(ours.name.replace("udpin", "udpout")))
    watch = Watch(gateway.services, [watcher(ours)])
    gateway.open_tick()
    sender = station()
    theirs.send(sender.frame(Command(1.0, 0.0, 0, 1, 1, 0)) + sender.frame(request(512, 32.0)))
    watch.poll(lambda: gateway.state)

    seen = heard(theirs)
    assert not gateway.answered
    assert {CommandAck, LocalPositionNed, Heartbeat} <= {type(message) for message in seen}
    position = next(each for each in seen if isinstance(each, LocalPositionNed))
    assert (position.x, position.y) == (-2.0, -3.0)


def heard(endpoint: Endpoint) -> list[Message]:
    receiver, messages = Receiver(), list[Message]()
    while data := endpoint.receive(0.2):
        messages += [frame.message for frame in receiver.receive(data)]
    return messages


def test_a_watcher_that_stops_reading_is_let_go(
    robot: Robot, stack: ExitStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tty, "STALL_TIMEOUT", 0.01)
    gateway = gateway_of(robot)
    line = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'watch'}"))
    watch = Watch(gateway.services, [watcher(line)])
    for _ in range(3000):
        watch.tell([Heartbeat(0, 10, 0, 0, 4, 3)])

    assert watch.take_lost() == [line.name]
    assert watch.take_lost() == []
    watch.tell([Heartbeat(0, 10, 0, 0, 4, 3)])
