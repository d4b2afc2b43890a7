"""Whom the robot in C hears, what it follows, and how it stops."""

import math
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from select import select
from typing import Any

import pytest
from msgspec.structs import replace

from laglab_protocol import (
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Command,
    CommandAck,
    CommandLong,
    End,
    EndReason,
    Measurement,
    Message,
    Receiver,
    Sender,
    Tick,
    make_key,
    open_endpoint,
    read_key,
)
from laglab_protocol.signing.signature import MINUTE, Signer, Verifier, signing_time

from .line import PERIOD, Line, begin, command


def test_a_request_to_another_robot_is_not_answered(line: Line) -> None:
    begin(line)
    line.say(request(target=2))
    assert not [each for each in line.hear(0.1) if isinstance(each, CommandAck)]
    line.say(request(target=ROBOT_SYSTEM))
    heard = line.hear_until(lambda message: isinstance(message, CommandAck))
    (ack,) = [each for each in heard if isinstance(each, CommandAck)]
    assert (ack.command, ack.result) == (512, 3)


def request(target: int) -> CommandLong:
    return CommandLong(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 512, target, ROBOT_COMPONENT, 0)


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
    late: list[float] = []
    while len(late) < 500:
        (*_, newest), now = line.samples(1), time.monotonic()
        late.append(now - newest.tick * PERIOD)
    drift = min(late[-100:]) - min(late[:100])  # either is late at times, nothing comes early
    assert abs(drift) < 0.1 * 400 * PERIOD


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


def test_what_is_not_finite_keeps_no_place_from_others(line: Line) -> None:
    begin(line)
    line.say(command(6 + 64_000, math.nan), command(6, 0.25))
    assert line.samples_from(6, 1)[0].speeds == (0.25, 0.0)


def test_what_answers_a_tick_that_is_far_from_come_keeps_no_place_from_others(line: Line) -> None:
    begin(line)
    line.say(command(2**31 - 1, 1.0), command(6, 0.25))
    assert line.samples_from(6, 1)[0].speeds == (0.25, 0.0)


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
        while not select([robot.stderr], [], [], 0.0)[0]:  # it may take a moment to open the port
            early.say(STATION_HEARTBEAT)
            heard += early.hear(0.02)
        assert "set the clocks of both sides" in robot.stderr.readline()
        assert heard == []
        signer = Signer(key, stream)
        begin(early._replace(sender=Sender(STATION_SYSTEM, STATION_COMPONENT, signer)))


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
