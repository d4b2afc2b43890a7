"""The station looking at itself: how long its ticks take, and whether popf's gain is too high."""

from array import array
from typing import NamedTuple

import numpy as np


class TickTimes(NamedTuple):
    """How long a tick waited for the station's answer [s]: half of the ticks, 99 %, all."""

    p50: float
    p99: float
    longest: float


class StationReport(NamedTuple):
    """How a station's run went."""

    command_delay: int
    """n [ticks], as the robot's echoes have it at the end."""
    measurement_delay: int | None
    """m [ticks] of the last measurement."""
    tick_times: TickTimes | None
    """None for a station without a clock, or without ticks."""
    warnings: tuple[str, ...]


def tick_times(nanoseconds: "array[int]") -> TickTimes | None:
    """Of all ticks timed."""
    if not nanoseconds:
        return None
    p50, p99, longest = np.percentile(np.array(nanoseconds), [50, 99, 100]) / 1e9
    return TickTimes(float(p50), float(p99), float(longest))
