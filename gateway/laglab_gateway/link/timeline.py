"""Impairments that come and go at given times."""

import math
from collections.abc import Sequence
from typing import Annotated, Literal

from laglab_gateway.link.impairments import IDEAL, Impairments
from laglab_gateway.values import Duration, Seconds, checked, described

ROUNDING = 1e-9

Direction = Literal["command", "measurement"]
DIRECTIONS: tuple[Direction, Direction] = ("command", "measurement")


@checked
class Event:
    """From `at` on, for `duration`, `link` stands in for the link's own impairments."""

    at: Annotated[Seconds, described("s", "When it begins.")] = 0.0
    duration: Annotated[
        Duration, described("s", "How long it lasts; `inf`: to the end of the run.")
    ] = math.inf
    link: Annotated[
        Impairments, described("-", "What the link does meanwhile, instead of what it does else.")
    ] = IDEAL
    direction: Annotated[
        Literal[Direction, "both"],
        described("-", "What it concerns: `command`, `measurement` or `both`."),
    ] = "both"

    def concerns(self, direction: Direction) -> bool:
        """Whether it changes this direction of the link."""
        return self.direction in (direction, "both")


def within(time: float, start: float, duration: float) -> bool:
    """Whether `time` is in [start, start + duration) [s], up to the rounding of sums of doubles."""
    return -ROUNDING <= time - start < duration - ROUNDING


def first_tick(time: float, sample_time: float) -> int:
    """The first tick that is not earlier than `time` [s], up to the same rounding."""
    return math.ceil((time - ROUNDING) / sample_time)


def in_force(base: Impairments, events: Sequence[Event], time: float) -> Impairments:
    """The impairments at `time` [s]: where events overlap, the later in the list wins."""
    for event in reversed(events):
        if within(time, event.at, event.duration):
            return event.link
    return base
