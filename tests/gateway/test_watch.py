"""Several who watch on one link, and those who only pretend to: over real UDP and a real pty."""

import os
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab_gateway import Safety, Services, Watch, Watcher, standard_parameters
from laglab_gateway.loops import watch
from laglab_gateway.loops.datagrams import LARGEST_SENT
from laglab_gateway.services import Askers, RobotState, asker
from laglab_protocol import (
    EVERY_MESSAGE,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_HEARTBEAT,
    Codec,
    CommandAck,
    CommandLong,
    Endpoint,
    Listener,
    LocalPositionNed,
    Message,
    ParamRequestList,
    ParamSet,
    ParamValue,
    Receiver,
    Sender,
    frames_in,
    make_key,
    open_endpoint,
)
from laglab_protocol.dialect.generated import laglab as mavlink
from laglab_protocol.endpoints import tty

STATE = RobotState(0, 3.0, 4.0, 0.0, 0.0, 0.0)


class Watched:
    """A robot's services, watched on one link."""

    def __init__(self, endpoint: Endpoint, codec: Codec, unsigned: bool = False) -> None:
        allow = EVERY_MESSAGE if unsigned else frozenset[str]()
        sender, receiver = codec.on_another_link(allow)
        self.endpoint = endpoint
        self.services = Services(standard_parameters(0, 0, Safety()))
        self.watch = Watch(
            self.services, [Watcher(Listener(endpoint, receiver), sender, trusting=not unsigned)]
        )

    def for_a_while(self, seconds: float) -> None:
        for _ in range(round(seconds * 1000)):
            CLOCK.milliseconds += 1
            self.watch.poll(lambda: STATE)


class Clock:
    """The watch's: a machine that is busy with other things does not change what it serves."""

    milliseconds = 0

    def now(self) -> int:
        return self.milliseconds * 1_000_000


CLOCK = Clock()


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watch, "monotonic_ns", CLOCK.now)


@pytest.fixture
def watched(stack: ExitStack) -> Watched:
    endpoint = stack.enter_context(open_endpoint("udpin://127.0.0.1:0"))
    return Watched(endpoint, Codec(ROBOT_SYSTEM, ROBOT_COMPONENT))


@pytest.fixture
def station(stack: ExitStack, watched: Watched) -> Callable[[], Endpoint]:
    url = watched.endpoint.name.replace("udpin", "udpout")
    return lambda: stack.enter_context(open_endpoint(url))


def datagrams(endpoint: Endpoint) -> list[bytes]:
    return list(iter(lambda: endpoint.receive(0.0), b""))


def heard(endpoint: Endpoint) -> list[Message]:
    return [each.message for data in datagrams(endpoint) for each in frames_in(data)]


def count(endpoint: Endpoint, kind: type[Message]) -> int:
    return sum(isinstance(message, kind) for message in heard(endpoint))


def test_two_on_one_link_are_served_apart(
    watched: Watched, station: Callable[[], Endpoint]
) -> None:
    """Each sees the telemetry at its own pace, and its own answers; none sees a gap."""
    first, second = station(), station()
    for each, system in ((first, 255), (second, 254)):
        each.send(Sender(system, 190).frame(STATION_HEARTBEAT))
    watched.for_a_while(0.05)
    slower = CommandLong(32.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 511, 1, 1, 0)
    second.send(Sender(254, 190).frame(slower))
    watched.for_a_while(0.05)
    receiver = Receiver()
    seen = [each.message for data in datagrams(second) for each in receiver.receive(data, True)]
    assert sum(isinstance(each, CommandAck) for each in seen) == 1
    assert count(first, CommandAck) == 0

    watched.for_a_while(1.0)
    assert count(first, LocalPositionNed) in {9, 10, 11}
    after = [each.message for data in datagrams(second) for each in receiver.receive(data, True)]
    assert sum(isinstance(each, LocalPositionNed) for each in after) == 0
    assert receiver.counters.lost == {}


@pytest.mark.parametrize("per_second", [10, 50])
def test_what_is_asked_for_so_often_comes_so_often(
    watched: Watched, station: Callable[[], Endpoint], per_second: int
) -> None:
    watcher = station()
    pace = CommandLong(32.0, 1e6 / per_second, 0.0, 0.0, 0.0, 0.0, 0.0, 511, 1, 1, 0)
    watcher.send(Sender(255, 190).frame(pace))
    watched.for_a_while(0.1)
    datagrams(watcher)
    watched.for_a_while(1.0)
    assert count(watcher, LocalPositionNed) == pytest.approx(per_second, rel=0.05, abs=1)


def test_a_datagram_of_148_requests_gets_a_few_short_answers(
    watched: Watched, station: Callable[[], Endpoint]
) -> None:
    stranger = station()
    request = Sender(7, 7).frame(ParamRequestList(1, 1))
    for _ in range(10):
        stranger.send(request * 148)
        watched.for_a_while(0.02)
    answers = datagrams(stranger)
    values = [each for data in answers for each in frames_in(data)]
    assert max(map(len, answers)) <= LARGEST_SENT
    assert 5 <= sum(isinstance(each.message, ParamValue) for each in values) <= 100

    friend = station()
    friend.send(Sender(255, 190).frame(ParamRequestList(1, 1)))
    watched.for_a_while(1.0)
    assert count(friend, ParamValue) == 5, "others are answered as ever"


def test_a_flood_of_garbage_is_looked_at_a_little_at_a_time(
    watched: Watched, station: Callable[[], Endpoint]
) -> None:
    stranger = station()
    for _ in range(80):
        stranger.send(b"\xfd" * 1400)
    watched.watch.poll(lambda: STATE)
    assert len(datagrams(watched.endpoint)) >= 70, "the rest waits, or is lost"


def test_a_serial_watcher_that_never_reads_costs_the_loop_nothing(
    stack: ExitStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'watch'}"))
    far = os.open(tmp_path / "watch", os.O_RDWR | os.O_NOCTTY)
    stack.callback(os.close, far)
    watched = Watched(line, Codec(ROBOT_SYSTEM, ROBOT_COMPONENT))
    waits: list[float] = []
    monkeypatch.setattr(tty, "writable", lambda _, timeout: bool(waits.append(timeout)))
    began = time.monotonic()
    while not (lost := watched.watch.take_lost()) and time.monotonic() < began + 10:
        watched.watch.tell([STATION_HEARTBEAT] * 50)
        time.sleep(0.01)
    assert lost == [line.name], "let go in the end"
    assert waits == [], "for room, at no time"


def test_who_signs_nothing_beside_a_key_may_not_set_what_the_robot_does(
    stack: ExitStack, tmp_path: Path
) -> None:
    key = tmp_path / "key"
    make_key(key)
    ours = stack.enter_context(Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, key))
    endpoint = stack.enter_context(open_endpoint("udpin://127.0.0.1:0"))
    watched = Watched(endpoint, ours, unsigned=True)
    theirs = stack.enter_context(open_endpoint(endpoint.name.replace("udpin", "udpout")))
    before = watched.services.parameters["V_MAX"]
    faster = ParamSet(100.0, 1, 1, b"V_MAX", mavlink.MAV_PARAM_TYPE_REAL32)
    place = CommandLong(9.0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 52100, 1, 1, 0)
    disarm = CommandLong(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 400, 1, 1, 0)

    stranger = Sender(255, 190)
    for message in (disarm, faster, place):
        theirs.send(stranger.frame(message))
    watched.for_a_while(0.05)
    assert not watched.services.arming.armed, "it may stop the robot"
    assert watched.services.parameters["V_MAX"] == before
    assert watched.services.arming.take_reset() is None

    holder = stack.enter_context(Codec(255, 190, key)).sender
    for message in (faster, place):
        theirs.send(holder.frame(message))
    watched.for_a_while(0.05)
    assert watched.services.parameters["V_MAX"] == 100.0
    assert watched.services.arming.take_reset() is not None


def test_who_left_is_told_nothing_more() -> None:
    askers = Askers(watching=True)
    askers.heard_from(None, 0.0)
    askers.heard_from("gone", 100.0)
    askers.heard_from("there", 150.0)
    askers.forget_silent(161.0)
    assert [address for address, _ in askers.known()] == [None, "there"]


def test_to_who_left_the_watch_sends_nothing_more(
    watched: Watched, station: Callable[[], Endpoint], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asker, "GONE", 0.2)
    watcher = station()
    watcher.send(Sender(255, 190).frame(STATION_HEARTBEAT))
    watched.for_a_while(0.15)
    assert heard(watcher)
    watched.for_a_while(0.2)
    datagrams(watcher)
    watched.for_a_while(0.3)
    assert datagrams(watcher) == []
