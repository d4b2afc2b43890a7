"""Play-out: what comes early waits until it is as old as what comes late."""

import heapq
from collections.abc import Iterable
from typing import Generic, Protocol, TypeVar


class Stamped(Protocol):
    """A message that says of which tick it is."""

    @property
    def tick(self) -> int:
        """Its stamp."""
        ...


S = TypeVar("S", bound=Stamped)


class Playout(Generic[S]):
    """Gives out each message `bound` ticks after its stamp, and not sooner; one that comes later
    than that is late, and never given out. So all have the same delay. Raises ValueError for a
    `bound` below 1."""

    def __init__(self, bound: int) -> None:
        if bound < 1:
            raise ValueError(f"a play-out is a number of ticks, 1 or more, not {bound}")
        self.bound = bound
        self._waiting: list[tuple[int, int, S]] = []
        self._taken = 0

    def take(self, tick: int, came: Iterable[S]) -> list[S]:
        """Take what came at `tick`; returns those that are late."""
        late = []
        for message in came:
            if tick > message.tick + self.bound:
                late.append(message)
            else:
                self._taken += 1
                heapq.heappush(self._waiting, (message.tick, self._taken, message))
        return late

    def due(self, tick: int) -> list[S]:
        """What is to be given out at `tick`, or was before it: by stamp, then as it came."""
        due = []
        while self._waiting and self._waiting[0][0] + self.bound <= tick:
            due.append(heapq.heappop(self._waiting)[2])
        return due

    def clear(self) -> None:
        """Nobody waits for what is held any more."""
        self._waiting.clear()
