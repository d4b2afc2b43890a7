"""TIMESYNC: how far a peer's clock is from ours, and how long the way there and back takes.

Not for lock-step: where time is simulated there are no two clocks to compare.
"""

from collections import deque
from collections.abc import Callable
from statistics import median

from laglab_gateway.record.audit import ClockReport
from laglab_protocol import Durations, Message, Timesync

OFFSETS_KEPT = 1000
"""The last ones: clocks drift, so the older ones tell less."""


class Timesyncing:
    """Asks, answers and measures by `clock` [ns], which must not go back."""

    def __init__(self, clock: Callable[[], int]) -> None:
        self._clock = clock
        self._asked: int | None = None
        self._offsets: deque[int] = deque(maxlen=OFFSETS_KEPT)
        self._round_trips = Durations()

    def ask(self) -> Timesync:
        """The question; the answer to any earlier one no longer counts."""
        self._asked = self._clock()
        return Timesync(tc1=0, ts1=self._asked)

    def answer(self, message: Timesync) -> list[Message]:
        """Answer a question; take an answer to ours as a sample."""
        now_ns = self._clock()
        if message.tc1 == 0:
            return [Timesync(tc1=now_ns, ts1=message.ts1)]
        if message.ts1 == self._asked:
            self._asked = None
            # Its clock at the answer, less ours half way between question and answer.
            self._offsets.append(message.tc1 - (message.ts1 + now_ns) // 2)
            self._round_trips.add(now_ns - message.ts1)
        return []

    def report(self) -> ClockReport | None:
        """None without an answer."""
        quantiles = self._round_trips.quantiles()
        if quantiles is None:
            return None
        offset = median(self._offsets) * 1e-9
        return ClockReport(offset, quantiles.p50, quantiles.p99, len(self._round_trips))
