"""The link's two delays, exact in ticks."""

from collections import deque
from typing import Generic, TypeVar

Item = TypeVar("Item")


class DelayLine(Generic[Item]):
    """Holds each item back for exactly ``delay`` ticks; 0 lets it through in its own tick."""

    def __init__(self, delay: int) -> None:
        if delay < 0:
            raise ValueError(f"a delay is a number of ticks, 0 or more, not {delay}")
        self.delay = delay
        self._waiting: deque[tuple[int, Item]] = deque()

    def push(self, tick: int, item: Item) -> None:
        """Put in ``item`` at ``tick``; ticks never go back."""
        self._waiting.append((tick + self.delay, item))

    def due(self, tick: int) -> list[Item]:
        """Take out, oldest first, all that has waited for ``delay`` ticks or more."""
        due = []
        while self._waiting and self._waiting[0][0] <= tick:
            due.append(self._waiting.popleft()[1])
        return due
