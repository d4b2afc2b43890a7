"""The robot in C, spoken to over a pty by a station made of the codec alone."""

import math
import sys
import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from msgspec.structs import replace

from laglab_conformance import Mark, conform
from laglab_protocol import (
    NO_COMMAND,
    NO_PROBE,
    PROBE_FILLER,
    PROBE_LAGS,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    CommandAck,
    CommandLong,
    End,
    Endpoint,
    EndReason,
    Heartbeat,
    Measurement,
    Message,
    Probe,
    Receiver,
    Sender,
    Tick,
    make_key,
    open_endpoint,
    read_key,
)
from laglab_protocol.signing.signature import MINUTE, Signer, Verifier, signing_time

SPEED = 4.0
PERIOD = 0.01 / SPEED
HEARTBEAT = Heartbeat(0, 6, 8, 0, 4, 3)


class Line(NamedTuple):
    """What a station has of the robot."""

    endpoint: Endpoint
    sender: Sender
    receiver: Receiver

    def say(self, *messages: Message) -> None:
        self.endpoint.send(b"".join(map(self.sender.frame, messages)))

    def hear(self, seconds: float) -> list[Message]:
        """All that comes within so long a time."""
        deadline = time.monotonic() + seconds
        heard: list[Message] = []
        while (left := deadline - time.monotonic()) > 0:
            heard += self._next(left)
        return heard

    def hear_until(self, done: Callable[[Message], bool]) -> list[Message]:
        """All that comes up to a message, and in one piece with it."""
        heard: list[Message] = []
        while not any(map(done, heard)):
            heard += self._next(5.0)
        return heard

    def samples(self, number: int) -> list[Measurement]:
        """So many measurements, or a few more."""
        heard: list[Measurement] = []
        while len(heard) < number:
            heard += [each for each in self._next(5.0) if isinstance(each, Measurement)]
        return heard

    def samples_from(self, stamp: int, number: int) -> list[Measurement]:
        """So many measurements, or a few more, from the first that echoes a command on."""
        heard: list[Measurement] = []
        while len(heard) < number:
            heard += [each for each in self.samples(1) if heard or each.command_tick == stamp]
        return heard

    def _next(self, timeout: float) -> list[Message]:
        frames = self.receiver.receive(self.endpoint.receive(timeout))
        return [frame.message for frame in frames]


@pytest.fixture
def line(start: Callable[..., Any], firmware: Path, tmp_path: Path) -> Iterator[Line]:
    with open_endpoint(f"pty://{tmp_path}/port") as endpoint:
        robot = start(firmware, "--speed", SPEED, tmp_path / "port")
        yield Line(endpoint, Sender(STATION_SYSTEM, STATION_COMPONENT), Receiver())
    assert robot.wait(5) == 1
    assert "the far end is gone" in robot.stderr.read()


@pytest.mark.slow
def test_it_conforms_signed_on_a_line_at_the_pace_of_a_real_one(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    """Where frames come in pieces; mavgen's parser alone would pass over what follows a false
    start."""
    make_key(tmp_path / "key")
    ports = [tmp_path / "robot", tmp_path / "station"]
    cable = start(sys.executable, "-m", "laglab", "serial", *ports, "--baud", "115200")
    assert "are joined" in cable.stderr.readline()
    start(firmware, "--key", tmp_path / "key", ports[0])
    url, key = f"serial://{ports[1]}:115200", tmp_path / "key"
    report = conform(url, "robot", key, pace="realtime")

    assert report.conforms, report.table()
    tried = {each.name: each.mark for each in report.results if each.group == "signing"}
    assert set(tried.values()) == {Mark.PASSED}


@pytest.mark.slow
def test_the_kits_command_waits_for_it(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    """As its README says: first the kit, which makes the port, then the robot."""
    url, options = f"pty://{tmp_path}/port", ("--side", "robot", "--pace", "realtime")
    kit = start(sys.executable, "-m", "laglab", "conform", url, *options)
    assert f"testing the robot at {url}" in kit.stderr.readline()
    while not (tmp_path / "port").exists():
        time.sleep(0.01)
    start(firmware, tmp_path / "port")

    told, _ = kit.communicate(timeout=50)
    assert kit.returncode == 0, told
    assert "the robot conforms" in told


def test_the_link_to_it_is_measured_as_its_readme_says(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    probe = ("link", "probe", f"pty://{tmp_path}/port", "--wait", "30", "--duration", "0.5")
    measuring = start(sys.executable, "-m", "laglab", *probe, "--clocks-within", "0")
    while not (tmp_path / "port").exists():
        time.sleep(0.01)
    start(firmware, tmp_path / "port")
    _, errors = measuring.communicate(timeout=30)
    assert measuring.returncode == 0, errors
    rows = [line.split(",") for line in (tmp_path / "link.csv").read_text().splitlines()[1:]]
    assert [row[1] for row in rows if row[0] == "measurement"] == list(map(str, range(50)))
    late = [float(row[6]) for row in rows if row[0] == "command" and row[5] == "delivered"]
    assert len(late) > 40
    assert max(late) > 0.001, "it reads its port once a tick"


def test_a_request_to_another_robot_is_not_answered(line: Line) -> None:
    begin(line)
    line.say(request(target=2))
    assert not [each for each in line.hear(0.1) if isinstance(each, CommandAck)]
    line.say(request(target=ROBOT_SYSTEM))
    (ack,) = [each for each in line.hear(0.3) if isinstance(each, CommandAck)]
    assert (ack.command, ack.result) == (512, 3)


def request(target: int) -> CommandLong:
    return CommandLong(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 512, target, ROBOT_COMPONENT, 0)


def begin(line: Line) -> Measurement:
    """Its first measurement; the robot may take a moment to open the port."""
    heard: list[Message] = []
    while not heard:
        line.say(HEARTBEAT)
        heard = line.hear(0.02)
    assert isinstance(heard[0], Measurement)
    return heard[0]


def command(tick: int, v: float, omega: float = 0.0) -> Command:
    return Command(v, omega, tick, ROBOT_SYSTEM, ROBOT_COMPONENT, 0)


def test_it_says_nothing_until_greeted_and_stands_still_until_commanded(line: Line) -> None:
    assert line.hear(0.1) == []
    first = begin(line)
    assert (first.tick, first.v, first.omega, first.command_tick) == (0, 0.0, 0.0, NO_COMMAND)
    heard = line.hear_until(lambda message: message == Tick(90, 1))
    samples = [message for message in heard if isinstance(message, Measurement)]
    ticks = [message for message in heard if isinstance(message, Tick)]
    assert ticks == [Tick(sample.tick, 1) for sample in samples]
    assert all(later.tick == earlier.tick + 1 for earlier, later in pairwise(samples))
    assert {(each.v, each.omega, each.command_tick) for each in samples} == {(0, 0, NO_COMMAND)}
    for axis, there in enumerate((-3.0, -3.0, 0.0)):
        mean = sum(sample.pose[axis] for sample in samples) / len(samples)
        assert mean == pytest.approx(there, abs=0.01)


def test_its_clock_keeps_time(line: Line) -> None:
    begin(line)
    earlier, began = line.samples(20)[-1], time.monotonic()
    later = line.samples(400)[-1]
    ticks = (time.monotonic() - began) / PERIOD
    assert later.tick - earlier.tick == pytest.approx(ticks, rel=0.1)


def test_a_fresh_command_drives_it_by_equation_3(line: Line) -> None:
    begin(line)
    line.say(command(3, 0.5, 1.0))
    first, *_, last = line.samples_from(3, 30)
    assert (last.speeds, last.command_tick) == ((0.5, 1.0), 3)
    t = (last.tick - (first.tick - 1)) * 0.01
    assert last.theta == pytest.approx(t, abs=0.05)
    assert last.x == pytest.approx(-3 + 0.5 * math.sin(t), abs=0.05)
    assert last.y == pytest.approx(-3 + 0.5 * (1 - math.cos(t)), abs=0.05)


@pytest.mark.parametrize(
    "bad",
    [
        command(5, 1.0),
        command(4, 1.0),
        command(10**6, math.nan),
        command(10**6, 1.0, math.inf),
        replace(command(10**6, 1.0), target_system=2),
        replace(command(10**6, 1.0), target_component=2),
    ],
    ids=["same", "stale", "nan", "infinite", "for another system", "for another component"],
)
def test_what_it_does_not_follow(line: Line, bad: Command) -> None:
    begin(line)
    line.say(command(5, 0.25))
    line.samples_from(5, 1)
    line.say(bad)
    assert {(sample.v, sample.command_tick) for sample in line.samples(20)} == {(0.25, 5)}


def test_nobody_but_the_station_commands_it(line: Line) -> None:
    begin(line)
    stranger = line._replace(sender=Sender(7, STATION_COMPONENT))
    stranger.say(command(5, 1.0), End(0, EndReason.COMPLETED))
    assert {sample.command_tick for sample in line.samples(20)} == {NO_COMMAND}


def test_who_signs_far_ahead_of_its_clock_is_refused_and_locks_nobody_out(
    start: Callable[..., Any], firmware: Path, tmp_path: Path
) -> None:
    make_key(tmp_path / "key")
    key, stream = read_key(tmp_path / "key"), (0, STATION_SYSTEM, STATION_COMPONENT)
    ahead = Signer(key, stream, clock=lambda: signing_time() + 2 * MINUTE)
    with open_endpoint(f"pty://{tmp_path}/port") as endpoint:
        robot = start(firmware, "--key", tmp_path / "key", tmp_path / "port")
        receiver = Receiver(Verifier(key))
        early = Line(endpoint, Sender(STATION_SYSTEM, STATION_COMPONENT, ahead), receiver)
        heard: list[Message] = []
        for _ in range(20):
            early.say(HEARTBEAT)
            heard += early.hear(0.02)
        assert heard == []
        signer = Signer(key, stream)
        begin(early._replace(sender=Sender(STATION_SYSTEM, STATION_COMPONENT, signer)))
    assert "set the clocks of both sides" in robot.stderr.readline()


def test_it_answers_whoever_measures_the_link_and_no_longer(line: Line) -> None:
    none, empty = (NO_PROBE,) * 3, (0,) * PROBE_FILLER
    heard: list[Message] = []
    for number in range(300):
        line.say(Probe(1, (0, 0, 0), 77, number, 10_000, none, empty))
        line.say(Probe(1, (0, 0, 0), 5, number, 10_000, none, empty))  # somebody else's
        heard += line.hear(PERIOD)
    heard += line.hear(0.1)
    told = [each for each in heard if isinstance(each, Probe)]
    assert len(told) == len(heard) > 200
    assert [each.sequence for each in told] == list(range(len(told)))
    assert {(each.session, each.interval_us) for each in told} == {(77, 10_000)}
    assert {len(Sender(1, 1).frame(each)) for each in told} == {75}
    for place, lag in enumerate(PROBE_LAGS):
        came = [each.came[place] for each in told if each.came[place] != NO_PROBE]
        first = came[0]
        assert came == list(range(first, first + len(came))), "each once, in order"
        assert len(came) > 200 - lag
    assert abs(told[0].came_ns[0] - time.time_ns()) < 60e9
    line.hear(1.0)  # its second without a probe is over by now
    assert line.hear(0.2) == []


def test_without_fresh_commands_it_ramps_to_a_stop_and_goes_on_with_the_next(line: Line) -> None:
    begin(line)
    line.say(command(5, 1.0, -1.0))
    samples = line.samples_from(5, 120)
    for sample in samples:
        silent = (sample.tick - samples[0].tick) * 0.01
        share = min(1.0, max(0.0, 1 - (silent - 0.5) / 0.5))
        assert (sample.v, sample.omega) == pytest.approx((share, -share))
    assert samples[-1].v == 0.0
    line.say(command(6, 0.5))
    assert line.samples_from(6, 1)[0].v == 0.5


def test_end_stops_it_and_a_greeting_begins_anew(line: Line) -> None:
    begin(line)
    line.say(command(5, 1.0))
    line.samples_from(5, 1)
    line.say(End(9, EndReason.INTERRUPTED))
    heard = line.hear_until(lambda message: isinstance(message, End))
    assert isinstance(heard[-1], End)
    assert heard[-1].reason == EndReason.INTERRUPTED
    assert line.hear(0.1) == []
    again = begin(line)
    assert (again.tick, again.v, again.command_tick) == (0, 0.0, NO_COMMAND)
