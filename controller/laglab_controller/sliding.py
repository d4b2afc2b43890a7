"""A product over a sliding window, at a cost per step that does not depend on its length."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple, TypeVar

Item = TypeVar("Item")
Product = TypeVar("Product")


class Cell(NamedTuple, Generic[Item, Product]):
    """One item of a stack, with the product of it and of all below."""

    item: Item
    factor: Product
    product: Product
    below: "Cell[Item, Product] | None"


@dataclass(frozen=True)
class SlidingProduct(Generic[Item, Product]):
    """A first-in first-out queue of items that knows the product of their factors.

    Two stacks make the queue: `back`, where items come, and `front`, where they leave; when the
    front runs empty the back is turned over onto it. Every product is made of factors of the
    present window only, so nothing is ever divided out and no rounding error builds up.
    Immutable; amortised three products per step.
    """

    compose: Callable[[Product, Product], Product]
    """`compose(older, newer)`, associative."""
    identity: Product
    front: Cell[Item, Product] | None = None
    back: Cell[Item, Product] | None = None

    @property
    def product(self) -> Product:
        """Of the whole window, oldest first."""
        if self.front is None:
            return self.identity if self.back is None else self.back.product
        if self.back is None:
            return self.front.product
        return self.compose(self.front.product, self.back.product)

    def push(self, item: Item, factor: Product) -> "SlidingProduct[Item, Product]":
        """With a newest item."""
        product = factor if self.back is None else self.compose(self.back.product, factor)
        return replace(self, back=Cell(item, factor, product, self.back))

    def pop(self) -> "tuple[Item, SlidingProduct[Item, Product]]":
        """The oldest item, and the queue without it. Raises IndexError when the queue is empty."""
        front, back = self.front, self.back
        if front is None:
            front, back = self._turned(), None
        if front is None:
            raise IndexError("the window is empty")
        return front.item, replace(self, front=front.below, back=back)

    def __iter__(self) -> Iterator[tuple[Item, Product]]:
        """Items and factors, oldest first."""
        for cell in _walk(self.front):
            yield cell.item, cell.factor
        for cell in reversed(list(_walk(self.back))):
            yield cell.item, cell.factor

    def _turned(self) -> Cell[Item, Product] | None:
        front: Cell[Item, Product] | None = None
        for cell in _walk(self.back):
            product = cell.factor if front is None else self.compose(cell.factor, front.product)
            front = Cell(cell.item, cell.factor, product, front)
        return front


def _walk(cell: Cell[Item, Product] | None) -> Iterator[Cell[Item, Product]]:
    while cell is not None:
        yield cell
        cell = cell.below
