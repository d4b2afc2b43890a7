"""The robot in C goes on by plans, and plays commands out."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from laglab_protocol import (
    STATION_COMPONENT,
    STATION_SYSTEM,
    Message,
    Planned,
    Receiver,
    Sender,
    Settings,
    open_endpoint,
)

from .line import Line, begin, command

SOON = 1000
"""Ticks of the line's robot in 2.5 s: nobody is held up for longer."""


def plan(tick: int, in_force: int, length: int) -> list[Message]:
    """Entry i is v = i/1000: the frames, and the command that they belong to."""
    following = tuple((i / 1000, 0.0) for i in range(1, length + 1))
    planned = Planned(replace(command(tick, 0.0), plan=length), in_force, following)
    return [*planned.frames(), planned.command]


def test_a_plan_is_read_off_tick_by_tick_then_held_and_the_failsafe_waits_for_its_end(
    line: Line,
) -> None:
    tick = begin(line).tick
    line.say(*plan(tick + 1, tick + SOON, 40))
    samples = line.samples_from(tick + 1, 140)
    assert samples[0].tick == tick + SOON + 1  # not before it is meant to be
    for sample in samples:
        ahead = sample.tick - 1 - (tick + SOON)
        share = min(1.0, max(0.0, 1 - ((ahead - 40) * 0.01 - 0.5) / 0.5))
        assert sample.v == pytest.approx(share * min(ahead, 40) / 1000)


def test_a_plan_of_which_a_frame_is_missing_is_not_followed_nor_its_command(line: Line) -> None:
    tick = begin(line).tick
    line.say(*plan(tick + 1, tick, 200))
    line.samples_from(tick + 1, 1)
    *frames, last = plan(tick + 2, tick, 40)
    line.say(frames[0], frames[2], last)
    samples = line.samples(20)
    assert {sample.command_tick for sample in samples} == {tick + 1}
    assert samples[-1].v == pytest.approx(min(samples[-1].tick - 1 - tick, 200) / 1000)
    line.say(frames[1])
    assert line.samples_from(tick + 2, 1)


def test_it_plays_commands_out(start: Callable[..., Any], firmware: Path, tmp_path: Path) -> None:
    with open_endpoint(f"pty://{tmp_path}/port") as endpoint:
        start(firmware, "--playout", 60, tmp_path / "port")
        line = Line(endpoint, Sender(STATION_SYSTEM, STATION_COMPONENT), Receiver())
        tick = begin(line).tick
        line.say(Settings(0.01))
        heard = line.hear_until(lambda message: isinstance(message, Settings))
        (told,) = [message for message in heard if isinstance(message, Settings)]
        assert told.command_playout == 60
        stamp = tick + 200  # in 2 s: nobody is held up for longer
        line.say(command(stamp, 0.1), command(stamp + 2, 0.2))
        first, *rest = line.samples_from(stamp, 10)
        assert first.tick == stamp + 61
        assert rest[1].command_tick == stamp + 2
        line.say(command(rest[-1].tick - 60, 0.3))
        assert {sample.command_tick for sample in line.samples(20)} == {stamp + 2}
