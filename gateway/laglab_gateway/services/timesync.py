"""TIMESYNC: how far a peer's clock is from ours, and how long the way there and back takes.

For a free-running gateway only: where time is simulated there are no two clocks to compare.
"""

from collections.abc import Callable
from typing import NamedTuple

from laglab_protocol import Message, Timesync


class Sample(NamedTuple):
    """One measurement [ns]: the peer's clock minus ours, and the round trip."""

    offset_ns: int
    round_trip_ns: int


class Timesyncing:
    """Asks, answers and measures by `clock` [ns], which must not go back."""

    def __init__(self, clock: Callable[[], int]) -> None:
        self._clock = clock
        self._asked: int | None = None
        self.samples: list[Sample] = []

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
            offset = message.tc1 - (message.ts1 + now_ns) // 2
            self.samples.append(Sample(offset, now_ns - message.ts1))
        return []
