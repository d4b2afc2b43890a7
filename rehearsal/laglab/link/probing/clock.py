"""The clock that probes are stamped by."""

import time

TRIES = 20
"""Whoever reads two clocks may be held up in between: the quickest reading counts."""


class WallClock:
    """The time of day [ns] when it was made, and on from there without a jump."""

    def __init__(self) -> None:
        _, self._ahead = min(_read_both() for _ in range(TRIES))

    def __call__(self) -> int:
        return self._ahead + time.monotonic_ns()


def _read_both() -> tuple[int, int]:
    """How long it took [ns], and how far the time of day is ahead of the clock that never jumps."""
    before = time.monotonic_ns()
    wall = time.time_ns()
    after = time.monotonic_ns()
    return after - before, wall - (before + after) // 2
