"""How late ticks on the wall clock begin."""

from msgspec import Struct

from laglab_protocol import Durations


class TimingReport(Struct, frozen=True):
    """How late ticks began [s]; a deadline is missed when a tick began a whole period late."""

    p50_s: float
    p99_s: float
    max_s: float
    missed_deadlines: int


class Lateness:
    """How late each tick began [s], and how many began after the next one was due."""

    def __init__(self, period: float) -> None:
        self._period = period
        self._durations = Durations()
        self._missed = 0

    def add(self, seconds: float) -> bool:
        """One more tick; True when it is the first that missed its deadline."""
        self._durations.add(int(seconds * 1e9))
        first = seconds > self._period and not self._missed
        self._missed += seconds > self._period
        return first

    def report(self) -> TimingReport | None:
        """None before the first tick."""
        quantiles = self._durations.quantiles()
        return TimingReport(*quantiles, self._missed) if quantiles else None
