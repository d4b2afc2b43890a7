"""What the last ticks have left of many robots.

What is looked up is taken by flat indices: for so few numbers that is several times as fast as
numpy's indexing by arrays.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch.impaired.timetable import Whole
from laglab_control.batch.rows import Row

Rows = NDArray[np.float64]
"""(rows, robots)"""
Stack = NDArray[np.float64]
"""(robots, 3, 3)"""


class Past:
    """So many rows a tick; what is older than `depth` ticks is written over."""

    def __init__(self, depth: int, rows: int, robots: int) -> None:
        self._kept = np.zeros((depth, rows, robots))
        self._depth = depth
        self._rows = np.arange(rows)[:, None] * robots
        """Where each begins in a tick's."""

    def at(self, tick: int) -> Rows:
        """Of all robots."""
        kept: Rows = self._kept[tick % self._depth]
        return kept

    def keep(self, tick: int, rows: Sequence[Row]) -> None:
        """Of all robots."""
        for kept, row in zip(self._kept[tick % self._depth], rows, strict=True):
            kept[:] = row

    def keep_of(self, tick: int, robots: Whole, rows: Sequence[Row] | Rows) -> None:
        """Of these."""
        kept = self._kept[tick % self._depth]
        if len(robots) == kept.shape[1]:
            kept[:] = rows
        else:
            kept[:, robots] = rows

    def of(self, ticks: Whole | int, robots: Whole) -> Rows:
        """Of these robots, each at a tick of its own."""
        rows: Rows = self._kept.take(self._where(ticks, robots))
        return rows

    def put(self, ticks: Whole, robots: Whole, rows: Rows) -> None:
        """Keep these there from now on."""
        self._kept.put(self._where(ticks, robots), rows)

    def _where(self, ticks: Whole | int, robots: Whole) -> Whole:
        _, rows, count = self._kept.shape
        where: Whole = self._rows + (ticks % self._depth * (rows * count) + robots)
        return where


class PastMatrices:
    """The same of matrices (3, 3)."""

    def __init__(self, depth: int, robots: int) -> None:
        self._kept = np.zeros((depth, robots, 3, 3))
        self._flat = self._kept.reshape(depth * robots, 9)
        self._depth, self._robots = depth, robots

    def keep(self, tick: int, robots: Whole, matrices: Stack) -> None:
        """Of these."""
        if len(robots) == self._robots:
            self._kept[tick % self._depth] = matrices
        else:
            self._kept[tick % self._depth, robots] = matrices

    def of(self, ticks: Whole | int, robots: Whole) -> Stack:
        """Of these, each at a tick of its own."""
        where = ticks % self._depth * self._robots + robots
        stack: Stack = self._flat.take(where, axis=0).reshape(-1, 3, 3)
        return stack
