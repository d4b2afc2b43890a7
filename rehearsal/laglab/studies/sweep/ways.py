"""Which way a cell's runs are made, and about how long that takes."""

from typing import NamedTuple

from laglab.studies.sweep.cell import Cell

TICK_ALONE = 160e-6
"""[s] A tick of a run by itself takes about so long, with both sides and the bytes between them."""
TICK_IN_BATCH = 1e-6
"""[s] A tick of one robot of many."""
RUN_ALONE = 0.02
"""[s] Until the sides of a run are there."""


class How(NamedTuple):
    """All at once, or one by one, and then why."""

    batch: bool
    because: str = ""

    def __str__(self) -> str:
        return "in a batch" if self.batch else f"one by one: {self.because}"


def how(cell: Cell) -> How:
    """Known from the cell's description alone, without running anything."""
    del cell
    return How(False, "there is no batch form of it")


def seconds(cell: Cell) -> float:
    """[s] About how long it takes, on one core."""
    ticks = cell.scenario.must_end()
    one = ticks * TICK_IN_BATCH if how(cell).batch else RUN_ALONE + ticks * TICK_ALONE
    return len(cell.seeds) * one
