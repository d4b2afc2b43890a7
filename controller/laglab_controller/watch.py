"""The station looking at itself: how long its ticks take, and whether popf's gain is too high."""

import math
from array import array
from typing import Any, NamedTuple

import numpy as np

from laglab_controller.estimator import State
from laglab_controller.popf import PopfState
from laglab_controller.rewinding import RewindingState


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


def delay_limit(m: int) -> float:
    """The gain above which (11) with a delay of m ticks is unstable, for a scalar at rest.

    x~_{k+1} = x~_k - K x~_{k-m} has its roots inside the unit circle for 0 < K < this limit
    (Levin and May 1976).
    """
    return 2 * math.sin(math.pi / (2 * (2 * m + 1)))


def largest_gain(state: State) -> float | None:
    """The highest gain of a component on its own innovation in popf's last correction."""
    inner: Any = state.state if isinstance(state, RewindingState) else state
    return 1.0 - min(inner.left.diagonal().tolist()) if isinstance(inner, PopfState) else None


def gain_warning(state: State, tick: int, m: int) -> str | None:
    """What to say when popf's gain is above the limit for a measurement m ticks late."""
    gain, limit = largest_gain(state), delay_limit(m)
    if gain is None or gain <= limit:
        return None
    return (
        f"tick {tick}: popf's gain is {gain:.3f}; above {limit:.3f} a delay of {m} ticks can make "
        "it diverge: take a smaller P_0, or delayed-ekf"
    )
