"""A bounded past, newest first, that shares its older part with every earlier version of itself."""

from collections.abc import Iterator
from itertools import islice
from typing import Generic, NamedTuple, TypeVar

Item = TypeVar("Item")


class Log(NamedTuple, Generic[Item]):
    """The newest item on top of an older log. Going back is following `older`."""

    newest: Item
    older: "Log[Item] | None"
    length: int


def append(log: Log[Item] | None, item: Item, limit: int) -> Log[Item]:
    """With `item` as the newest; at least the last `limit` items stay, at most twice as many."""
    if log is not None and log.length >= 2 * limit:
        log = _newest(log, limit)
    return Log(item, log, 1 if log is None else log.length + 1)


def newest_first(log: Log[Item] | None) -> Iterator[Item]:
    """All that is still kept."""
    while log is not None:
        yield log.newest
        log = log.older


def _newest(log: Log[Item], count: int) -> Log[Item] | None:
    kept: Log[Item] | None = None
    for length, item in enumerate(reversed(list(islice(newest_first(log), count))), start=1):
        kept = Log(item, kept, length)
    return kept
