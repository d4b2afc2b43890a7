"""One direction of the link: a fixed delay in ticks, and what the link does besides."""

import heapq
import math
from collections.abc import Callable
from typing import Generic, TypeVar

from laglab_gateway.link.fates import FateKind, Fates
from laglab_gateway.link.log import LinkRow
from laglab_gateway.link.timeline import Direction
from laglab_protocol import Message, Sender, frames_in

M = TypeVar("M", bound=Message)

ROUNDING = 1e-9
"""A frame due this little [ticks] after a tick is due at it: times are sums of doubles."""


class Channel(Generic[M]):
    """Holds each message back for exactly `delay` ticks; an impaired one for longer, or for ever.

    Everything happens on the grid of ticks: what would come out between two of them comes out at
    the later one. `sample_time` is in s. `fates` None is the ideal link. `frame` makes the bytes
    that an impaired link may queue and corrupt; by default they are a frame of the message. Raises
    ValueError for a negative delay.
    """

    def __init__(
        self,
        direction: Direction,
        delay: int,
        sample_time: float,
        fates: Fates | None = None,
        frame: Callable[[M], bytes] | None = None,
    ) -> None:
        if delay < 0:
            raise ValueError(f"a delay is a number of ticks, 0 or more, not {delay}")
        self._log: list[LinkRow] = []
        self._direction = direction
        self._delay = delay
        self._sample_time = sample_time
        self._fates = fates
        self._bytes_of = frame or Sender(0, 0).frame
        self._entered = 0
        self._frame = (-1, 0)
        self._waiting: list[tuple[int, int, M]] = []

    def push(self, tick: int, message: M, until: float = math.inf) -> None:
        """Put in `message` at `tick`; ticks never go back. What comes out after the tick `until` is
        of no use any more, and logged as late."""
        if self._fates is None:
            self._hold(tick, message, 0)
        else:
            self._impair(tick, message, until, self._fates)

    def due(self, tick: int) -> list[M]:
        """Take out all that has waited long enough: by its time, then in the order of entering."""
        due = []
        while self._waiting and self._waiting[0][0] <= tick:
            due.append(heapq.heappop(self._waiting)[2])
        return due

    def clear(self) -> None:
        """Lose all that is on its way."""
        self._waiting.clear()

    def take_log(self) -> list[LinkRow]:
        """What was done to every frame since the last call."""
        log, self._log = self._log, []
        return log

    def _hold(self, tick: int, message: M, extra_ticks: int) -> None:
        self._entered += 1
        due = tick + self._delay + extra_ticks
        heapq.heappush(self._waiting, (due, self._entered, message))

    def _impair(self, tick: int, message: M, until: float, fates: Fates) -> None:
        number = self._number(tick)
        raw = self._bytes_of(message)
        for copy, fate in enumerate(fates.of(tick, tick * self._sample_time, raw)):
            extra = math.ceil(fate.extra / self._sample_time - ROUNDING)
            late = fate.kind is FateKind.DELIVERED and tick + self._delay + extra > until
            kind = FateKind.LATE if late else fate.kind
            row = LinkRow(self._direction, tick, number, copy, len(raw), kind, fate.extra)
            self._log.append(row)
            received = _received(fate.kind, message, fate.raw)
            if received is not None:
                self._hold(tick, received, extra)

    def _number(self, tick: int) -> int:
        last, number = self._frame
        self._frame = (tick, number + 1 if tick == last else 0)
        return self._frame[1]


def _received(kind: FateKind, sent: M, raw: bytes) -> M | None:
    """A corrupted frame goes through a receiver: one in 65,536 gets past its CRC."""
    if kind is FateKind.DELIVERED:
        return sent
    if kind is not FateKind.CORRUPTED:
        return None
    for frame in frames_in(raw):
        if isinstance(frame.message, type(sent)):
            return frame.message
    return None
