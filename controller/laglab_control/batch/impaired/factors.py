"""(21) for many robots: M* from any past tick to the present."""

from laglab_control.batch.impaired.past import PastMatrices, Stack
from laglab_control.batch.impaired.timetable import Whole


class Factors:
    """Products of F_j = A_j (I - K_j), which take tick j to j + 1; later ones stand to the left.

    The ticks are cut into blocks no longer than the least delay. Of each block the products from
    its beginning on and up to its end are kept; so every M* from tick s to t is a product of a few
    of them, and a factor that changes changes only those of its own block.
    """

    def __init__(self, block: int, depth: int, robots: int) -> None:
        self._block = block
        self._factors = PastMatrices(depth, robots)
        self._from_begin = PastMatrices(depth, robots)
        """F_{t-1} ... F_b, where the block of t begins at b."""
        self._to_end = PastMatrices(depth, robots)
        """F_{e-1} ... F_s, where the block of s ends at e."""

    def keep(self, j: int, robots: Whole, factors: Stack) -> None:
        """F_j of these robots, when all before it are right."""
        self._factors.keep(j, robots, factors)
        if (j + 1) % self._block == 0:
            self._end(j, robots, factors)
        elif j % self._block == 0:
            self._from_begin.keep(j + 1, robots, factors)
        else:
            self._from_begin.keep(j + 1, robots, factors @ self._from_begin.of(j, robots))

    def _end(self, j: int, robots: Whole, product: Stack) -> None:
        """Of a block, whose last factor this is."""
        self._to_end.keep(j, robots, product)
        for older in range(j - 1, j - self._block, -1):
            product = product @ self._factors.of(older, robots)
            self._to_end.keep(older, robots, product)

    def since(self, s: Whole, tick: int, robots: Whole) -> Stack:
        """M* of these robots, each from its own s, in an earlier block, to `tick`."""
        block = self._block
        product = self._to_end.of(s, robots)
        between = tick // block - 1 - s // block
        for i in range(int(between.max())):
            there = between > i
            begin, of = (s[there] // block + 1 + i) * block, robots[there]
            product[there] = self._to_end.of(begin, of) @ product[there]
        if tick % block:
            product = self._from_begin.of(tick, robots) @ product
        return product
