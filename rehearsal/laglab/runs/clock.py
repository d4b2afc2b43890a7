"""How long a loop takes."""

from collections.abc import Callable
from time import monotonic

REPORT_INTERVAL = 0.1


class LoopClock:
    """Passes progress on ten times a second, and times the loop from its first tick to its last."""

    def __init__(self, report: Callable[[int], None]) -> None:
        self._report = report
        self._first = self._last = self._told = 0.0

    def __call__(self, tick: int) -> None:
        self._last = monotonic()
        self._first = self._first or self._last
        if self._last - self._told > REPORT_INTERVAL:
            self._told = self._last
            self._report(tick)

    @property
    def seconds(self) -> float:
        """From the end of the first tick to the end of the last [s]."""
        return self._last - self._first
