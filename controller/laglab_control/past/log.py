"""A bounded past that shares its items with every earlier version of itself."""

from collections.abc import Iterator
from typing import Generic, NamedTuple, TypeVar

Item = TypeVar("Item")


class Log(NamedTuple, Generic[Item]):
    """The first `length` of `items`, oldest first; to be made by `logged` and `append` alone.

    What the list holds after them belongs to later versions: no version ever changes.
    """

    items: list[Item]
    length: int

    @property
    def newest(self) -> Item:
        """The last one. Raises IndexError when there is none."""
        if not self.length:
            raise IndexError("the log is empty")
        return self.items[self.length - 1]


def logged(*items: Item) -> Log[Item]:
    """A log of these, oldest first."""
    return Log(list(items), len(items))


def append(log: Log[Item], item: Item, limit: int) -> Log[Item]:
    """With `item` as the newest; at least the last `limit` items stay, at most twice as many."""
    items, length = log
    if length >= 2 * limit:
        items = items[length - limit : length]
    elif length != len(items):
        items = items[:length]
    items.append(item)
    return Log(items, len(items))


def newest_first(log: Log[Item]) -> Iterator[Item]:
    """All that is still kept."""
    items, length = log
    return (items[i] for i in range(length - 1, -1, -1))


def cut(log: Log[Item], length: int) -> tuple[Log[Item], list[Item]]:
    """The log as it was at that length, and what came since, oldest first."""
    return Log(log.items, length), log.items[length : log.length]
