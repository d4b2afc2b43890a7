"""What the last ticks have left of many robots."""

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

    def at(self, tick: int) -> Rows:
        """Of all robots."""
        kept: Rows = self._kept[tick % self._depth]
        return kept

    def keep(self, tick: int, rows: Sequence[Row]) -> None:
        """Of all robots."""
        for kept, row in zip(self._kept[tick % self._depth], rows, strict=True):
            kept[:] = row

    def keep_of(self, tick: int, robots: Whole, rows: Sequence[Row]) -> None:
        """Of these."""
        self._kept[tick % self._depth][:, robots] = rows

    def of(self, ticks: Whole, robots: Whole) -> Rows:
        """Of these robots, each at a tick of its own."""
        rows: Rows = self._kept[ticks % self._depth, :, robots].T
        return rows

    def put(self, ticks: Whole, robots: Whole, rows: Rows) -> None:
        """The same to be kept from now on."""
        self._kept[ticks % self._depth, :, robots] = rows.T


class PastMatrices:
    """The same of matrices (3, 3)."""

    def __init__(self, depth: int, robots: int) -> None:
        self._kept = np.zeros((depth, robots, 3, 3))
        self._depth = depth

    def keep(self, tick: int, robots: Whole, matrices: Stack) -> None:
        """Of these."""
        self._kept[tick % self._depth, robots] = matrices

    def of(self, ticks: Whole | int, robots: Whole) -> Stack:
        """Of these, each at a tick of its own."""
        stack: Stack = self._kept[ticks % self._depth, robots]
        return stack
