"""Which way a cell's runs are made."""

from typing import NamedTuple

from laglab.studies.many import why_one_by_one
from laglab.studies.sweep.cell import Cell


class How(NamedTuple):
    """All at once, or one by one, and then why."""

    batch: bool
    because: str = ""

    def __str__(self) -> str:
        return "batch" if self.batch else f"one by one: {self.because}"


def how(cell: Cell) -> How:
    """Known from the cell's description alone, without running anything."""
    because = why_one_by_one(cell.scenario)
    return How(because is None, because or "")
