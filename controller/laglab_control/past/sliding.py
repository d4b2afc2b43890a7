"""A product over a sliding window, at a cost per step that does not depend on its length."""

from collections.abc import Callable, Iterator
from typing import Generic, NamedTuple, Self, TypeVar

Item = TypeVar("Item")
Product = TypeVar("Product")


class Stacked(NamedTuple, Generic[Item, Product]):
    """One item of a stack, with the product of it and of all below."""

    item: Item
    factor: Product
    product: Product
    below: "Stacked[Item, Product] | None"


class SlidingProduct(Generic[Item, Product]):
    """A first-in first-out queue of items that knows the product of their factors.

    Two stacks make the queue: the back, where items come, and the front, where they leave; when
    the front runs empty the back is turned over onto it. Every product is made of factors of the
    present window only, so nothing is ever divided out and no rounding error builds up.
    Immutable; on average three products per step.
    """

    __slots__ = ("_back", "_compose", "_front", "identity")

    def __init__(
        self,
        compose: Callable[[Product, Product], Product],
        identity: Product,
        front: Stacked[Item, Product] | None = None,
        back: Stacked[Item, Product] | None = None,
    ) -> None:
        """Empty when no stacks are given. `compose(older, newer)` must be associative."""
        self.identity = identity
        self._compose = compose
        self._front = front
        self._back = back

    @property
    def product(self) -> Product:
        """Of the whole window, oldest first."""
        if self._front is None:
            return self.identity if self._back is None else self._back.product
        if self._back is None:
            return self._front.product
        return self._compose(self._front.product, self._back.product)

    def push(self, item: Item, factor: Product) -> Self:
        """With a newest item."""
        return type(self)(self._compose, self.identity, self._front, self._longer(item, factor))

    def pop(self) -> tuple[Item, Self]:
        """The oldest item, and the queue without it. Raises IndexError when the queue is empty."""
        return self._without_oldest(self._back)

    def slide(self, item: Item, factor: Product) -> tuple[Item, Self]:
        """The item that is then the oldest, and the queue without it, with a newest one."""
        return self._without_oldest(self._longer(item, factor))

    def emptied(self) -> Self:
        """A new one for the same kind of products."""
        return type(self)(self._compose, self.identity)

    def __iter__(self) -> Iterator[Item]:
        """The items, oldest first."""
        for each in _walk(self._front):
            yield each.item
        for each in reversed(list(_walk(self._back))):
            yield each.item

    def _longer(self, item: Item, factor: Product) -> Stacked[Item, Product]:
        back = self._back
        product = factor if back is None else self._compose(back.product, factor)
        return Stacked(item, factor, product, back)

    def _without_oldest(self, back: Stacked[Item, Product] | None) -> tuple[Item, Self]:
        front = self._front
        if front is None:
            front, back = self._turned(back), None
        if front is None:
            raise IndexError("the window is empty")
        return front.item, type(self)(self._compose, self.identity, front.below, back)

    def _turned(self, back: Stacked[Item, Product] | None) -> Stacked[Item, Product] | None:
        front: Stacked[Item, Product] | None = None
        for each in _walk(back):
            product = each.factor
            if front is not None:
                product = self._compose(each.factor, front.product)
            front = Stacked(each.item, each.factor, product, front)
        return front


def _walk(each: Stacked[Item, Product] | None) -> Iterator[Stacked[Item, Product]]:
    while each is not None:
        yield each
        each = each.below
