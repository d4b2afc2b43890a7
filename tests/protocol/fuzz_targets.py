"""What is fuzzed: no bytes raise, memory stays bounded, what is not verified changes no state."""

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from laglab_control import StationConfig
from laglab_gateway import GatewayConfig, Relay, Safety, Services, standard_parameters
from laglab_gateway.services import RobotState
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    DialectError,
    Message,
    Receiver,
    Sender,
    frames_in,
)
from laglab_protocol.dialect.lint import lint
from laglab_protocol.dialect.mavgen import dialect_path
from laglab_protocol.framing.frame import Frame
from laglab_protocol.messages.layout import LAYOUT_OF_ID
from laglab_protocol.messages.loop import Command, End, Estimate, Measurement, Tick
from laglab_protocol.signing.signature import Signer, Timestamps, Verifier
from laglab_station import Station

LARGEST_FRAME = 10 + 255 + 2 + 13
REQUESTS = [
    LAYOUT_OF_ID[number]
    for number in (4, 11, 20, 21, 23, 43, 44, 48, 66, 75, 76, 110, 111, 117, 119, 183, 320, 323)
]
MESSAGES = [
    Measurement(1.5, -2.0, 3.0, 0.5, -1.7, 30, 20),
    Tick(30, 1),
    Estimate(*[1.0] * 9, tick=30),
    Command(0.5, -1.0, 30, 1, 1, 1),
    End(30, 0),
]
SPEAKER = Sender(1, 1)
STREAM = b"".join(SPEAKER.frame(message) for message in MESSAGES)
STRANGER = Sender(1, 1, Signer(bytes(32), (0, 1, 1)))
SIGNED_STREAM = b"".join(STRANGER.frame(message) for message in MESSAGES)
DIALECT = dialect_path().read_bytes().replace(b"<include>common.xml</include>", b"")
STATE = RobotState(0, 1.0, 2.0, 3.0, 0.0, 0.0)


def spoiled(good: bytes, data: bytes) -> bytes:
    """Something good with `data` over a part of it, so that the fuzzer gets in deep."""
    start = int.from_bytes(data[:2], "little") % len(good)
    return good[:start] + data[2:] + good[start + len(data[2:]) :]


def receiver(data: bytes) -> None:
    """A spoiled stream, cut anywhere."""
    cut, data = data[0] if data else 0, spoiled(STREAM, data[1:])
    under_test = Receiver()
    frames = under_test.receive(data[:cut]) + under_test.receive(data[cut:])
    assert len(under_test._rest) < LARGEST_FRAME
    frames += under_test.receive(b"", whole=True)
    assert under_test._rest == b""
    for frame in frames:
        SPEAKER.frame(frame.message)


def signed(data: bytes) -> None:
    """A spoiled stream, of which nothing can be signed with the key."""
    data = spoiled(SIGNED_STREAM, data)
    timestamps = Timestamps()
    under_test = Receiver(Verifier(bytes(range(32)), timestamps, clock=lambda: 10**13))
    assert under_test.receive(data, whole=True) == []
    assert timestamps.last == {}
    assert under_test._expected == {}


def linted(data: bytes) -> None:
    """A spoiled dialect."""
    data = spoiled(DIALECT, data)
    with tempfile.NamedTemporaryFile(suffix=".xml") as file:
        file.write(data)
        file.flush()
        try:
            lint(Path(file.name))
        except DialectError:
            return


def services(data: bytes) -> None:
    """Any payload of any request."""
    if not data:
        return
    layout = REQUESTS[data[0] % len(REQUESTS)]
    payload = data[1:].ljust(layout.size, b"\0")[: layout.size]
    message = layout.type(*layout.unpack(payload, 0))
    under_test = Services(standard_parameters(10, 20, Safety()))
    for answer in under_test.answer(Frame(message, 255, 190, 0, b""), STATE):
        Sender(1, 1).frame(answer)
    assert under_test.parameters["DELAY_N"] == 10


OURS = [layout for number, layout in LAYOUT_OF_ID.items() if number >= 52100]


def said(data: bytes) -> Iterator[Message]:
    """Messages of our own with whatever is in their fields."""
    while data:
        layout = OURS[data[0] % len(OURS)]
        payload, data = data[1 : 1 + layout.size], data[1 + layout.size :]
        yield layout.type(*layout.unpack(payload.ljust(layout.size, b"\0"), 0))


def station(data: bytes) -> None:
    """Whatever the robot says."""
    under_test, robot = Station(StationConfig()), Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
    for message in said(data):
        under_test.hear(frames_in(robot.frame(message)))
        under_test.look_ahead()


def relay(data: bytes) -> None:
    """Whatever the robot says, and the station the same."""
    safety = Safety()
    under_test = Relay(
        GatewayConfig(2, 3, 10**6, 0.01, safety), Services(standard_parameters(2, 3, safety))
    )
    robot, other = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT), Sender(STATION_SYSTEM, STATION_COMPONENT)
    for message in said(data):
        under_test.hear(frames_in(other.frame(message)))
        for frame in frames_in(robot.frame(message)):
            if under_test.hear_robot(frame):
                if under_test.under_way:
                    under_test.close_tick()
                under_test.open_tick()
        under_test.forward()


TARGETS: dict[str, Callable[[bytes], None]] = {
    "receiver": receiver,
    "signed": signed,
    "lint": linted,
    "services": services,
    "station": station,
    "relay": relay,
}
