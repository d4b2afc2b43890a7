"""The past ticks that what arrives late may refer to, oldest forgotten first."""

from collections.abc import Iterator
from typing import Generic, NamedTuple, TypeVar

from laglab_control.past.log import Log, append, newest_first
from laglab_control.past.sliding import SlidingProduct

Item = TypeVar("Item")
Product = TypeVar("Product")


class History(NamedTuple, Generic[Item, Product]):
    """One item per tick, split in two at the newest tick that anything has referred to.

    Going on in order costs the same however far back that tick is; going back behind it costs one
    step per tick. Immutable.
    """

    window: SlidingProduct[Item, Product]
    """The ticks after the split, with the product of their factors."""
    since: int
    """The oldest tick in the window."""
    older: Log[Item]
    """The ticks up to the split."""
    memory: int
    """How many ticks are kept at least."""

    def push(self, tick: int, item: Item, factor: Product) -> "History[Item, Product]":
        """With an item for `tick`, the next one."""
        window, since, older, memory = self
        longer = History(window.push(item, factor), since, older, memory)
        return longer.split(tick - memory) if since <= tick - memory else longer

    def split(self, at: int) -> "History[Item, Product]":
        """Leave in the window only the ticks after `at`, which must be in the past."""
        window, since, older, memory = self
        if since > at:
            return self
        while since <= at:
            item, window = window.pop()
            older = append(older, item, memory)
            since += 1
        return History(window, since, older, memory)

    def backwards(self) -> Iterator[Item]:
        """The items up to the split, newest first."""
        return newest_first(self.older)
