"""A trace for mahimahi's mm-link: when 1500 bytes may cross; what a run's frames then wait."""

import math
from collections.abc import Iterator, Sequence
from itertools import count, pairwise
from pathlib import Path

import numpy as np

from laglab.link.errors import LinkFileError
from laglab.link.importing.how import TICK, How
from laglab.link.measured import Array, Flow, MeasuredLink
from laglab_gateway import MOST_TICKS

OPPORTUNITY = 1500
"""[byte]"""
ROUNDING = 1e-9
"""[s]"""
LEAST = 10.0
"""[s] A shorter trace is gone through again until it is as long."""
NOTE = (
    "A trace tells how long frames wait for their turn; how long they then travel comes on top: "
    "set n and m to that."
)


def is_trace(numbers: Sequence[int]) -> bool:
    """Whether these may be milliseconds, one after the other."""
    rising = all(later >= earlier for earlier, later in pairwise(numbers))
    return bool(numbers) and rising and numbers[0] >= 0 and numbers[-1] > 0


def read_mahimahi(numbers: Sequence[int], how: How, name: str) -> MeasuredLink:
    """Both ways by this trace, or measurements by the one of `how.back`. Raises LinkFileError."""
    interval = how.interval or TICK
    _short_enough(numbers, interval, name)
    other = numbers if how.back is None else _numbers_in(how.back)
    _short_enough(other, interval, f"--back {how.back}")
    return MeasuredLink(
        _flow(numbers, how.sizes.command, interval),
        _flow(other, how.sizes.measurement, interval),
        interval,
        (NOTE,),
    )


def _short_enough(numbers: Sequence[int], interval: float, name: str) -> None:
    if numbers[-1] > MOST_TICKS * interval * 1e3:
        raise LinkFileError(
            f"{name}: ends at {float(min(numbers[-1], 10**300)):.3g} ms: more than {MOST_TICKS} "
            f"ticks of {interval:g} s: give a shorter trace or a longer --interval"
        )


def _numbers_in(path: Path) -> list[int]:
    try:
        numbers = [int(word) for word in path.read_text(encoding="ascii").split()]
    except (OSError, ValueError) as error:
        raise LinkFileError(f"--back {path}: no mahimahi trace: {error}") from error
    if not is_trace(numbers):
        raise LinkFileError(f"--back {path}: no mahimahi trace: milliseconds that rise")
    return numbers


def _flow(numbers: Sequence[int], size: int, interval: float) -> Flow:
    turns = int(np.ceil(LEAST * 1e3 / numbers[-1]))
    length = numbers[-1] * max(turns, 1) * 1e-3
    sent = interval * np.arange(max(1, int(length / interval)), dtype=np.float64)
    return Flow(sent, waited(numbers, sent, size) - sent, size)


def waited(trace: Sequence[int], sent: Array, size: int) -> Array:
    """When each of these frames has crossed [s].

    An opportunity carries 1500 bytes of what is there by then, pieces of frames too, and is lost
    where nothing is; the trace begins again at its end.
    """
    turns = _opportunities(trace)
    at, room = -math.inf, 0
    crossed = []
    for entered in sent:
        left = size
        while left > 0:
            while room == 0 or at < entered - ROUNDING:
                at, room = next(turns), OPPORTUNITY
            taken = min(left, room)
            left, room = left - taken, room - taken
        crossed.append(max(at, entered))
    return np.array(crossed)


def _opportunities(trace: Sequence[int]) -> Iterator[float]:
    """Their times [s], for ever."""
    for turn in count():
        yield from (1e-3 * (turn * trace[-1] + at) for at in trace)
