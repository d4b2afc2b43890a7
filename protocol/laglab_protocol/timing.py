"""How long things take, over any number of them: what is kept does not grow."""

from typing import NamedTuple

from hdrh.histogram import HdrHistogram

LONGEST_NS = 3600 * 10**9
DIGITS = 3
AT_A_TIME = 256
"""Durations that are sorted into the histogram together, which costs half as much."""


class Quantiles(NamedTuple):
    """Durations [s] that half of them, 99 % and all did not exceed."""

    p50: float
    p99: float
    longest: float


class Durations:
    """A streaming histogram of durations, to three digits; the longest exactly."""

    def __init__(self) -> None:
        self._histogram = HdrHistogram(1, LONGEST_NS, DIGITS)
        self._longest = 0
        self._waiting: list[int] = []

    def add(self, nanoseconds: int) -> None:
        """One more; less than nothing counts as nothing, more than an hour as an hour."""
        self._waiting.append(nanoseconds)
        if len(self._waiting) >= AT_A_TIME:
            self._sort_in()

    def _sort_in(self) -> None:
        for nanoseconds in self._waiting:
            self._histogram.record_value(min(max(nanoseconds, 1), LONGEST_NS))
        self._longest = max(self._longest, *self._waiting)
        self._waiting.clear()

    def __len__(self) -> int:
        return int(self._histogram.get_total_count()) + len(self._waiting)

    def quantiles(self) -> Quantiles | None:
        """None when there are none."""
        if not len(self):
            return None
        if self._waiting:
            self._sort_in()
        at = self._histogram.get_percentile_to_value_dict([50, 99])
        return Quantiles(at[50] * 1e-9, at[99] * 1e-9, self._longest * 1e-9)
