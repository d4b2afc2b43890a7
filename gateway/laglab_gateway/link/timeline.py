"""Impairments that come and go at given times."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from laglab_gateway.link.impairments import STRICT, Impairments, Seconds

ROUNDING = 1e-9

Direction = Literal["command", "measurement"]


@dataclass(frozen=True)
class Event:
    """From `at` [s] on, for `duration` [s], `link` stands in for the link's own impairments."""

    __pydantic_config__ = STRICT

    at: Seconds
    duration: Seconds
    link: Impairments
    direction: Direction | Literal["both"] = "both"

    def concerns(self, direction: Direction) -> bool:
        """Whether it changes this direction of the link."""
        return self.direction in (direction, "both")


def within(time: float, start: float, duration: float) -> bool:
    """Whether `time` is in [start, start + duration) [s], up to the rounding of sums of doubles."""
    return -ROUNDING <= time - start < duration - ROUNDING


def in_force(base: Impairments, events: Sequence[Event], time: float) -> Impairments:
    """The impairments at `time` [s]: where events overlap, the later in the list wins."""
    for event in reversed(events):
        if within(time, event.at, event.duration):
            return event.link
    return base
