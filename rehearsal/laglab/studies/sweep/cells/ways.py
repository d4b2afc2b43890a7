"""Which way a cell's runs are made, and about how long that takes."""

from collections.abc import Sequence
from typing import NamedTuple

from laglab.studies.judged import Judgements
from laglab.studies.many import is_ideal, why_one_by_one
from laglab.studies.sweep.cells.all_at_once import all_at_once
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.one_by_one import one_by_one

TICK_ALONE = 160e-6
"""[s] About what a tick of a run by itself takes: both sides, and the bytes between them."""
TICK_OF_A_BATCH, TICK_IN_A_BATCH = 400e-6, 0.8e-6
"""[s] A tick of however many robots, and what each of them adds."""
TICK_IMPAIRED = 75e-6
"""[s] A tick of one robot of many on an impaired link, its schedule included."""
CROWD = 200
"""Robots on impaired links: with more of them, each costs no less."""
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
    because = why_one_by_one(cell.scenario)
    return How(because is None, because or "")


def judged(cells: Sequence[Cell]) -> list[Judgements]:
    """What became of every cell's runs, made in whichever way. Raises RunError."""
    batch = [cell for cell in cells if how(cell).batch]
    together = iter(all_at_once(batch))
    return [next(together) if how(cell).batch else one_by_one(cell) for cell in cells]


def crowd(cell: Cell) -> int:
    """How many robots, of this cell and of others, are worth computing together."""
    return CROWD if how(cell).batch and not is_ideal(cell.scenario) else 1


def seconds(cell: Cell) -> float:
    """[s] About how long it takes, on one core."""
    ticks, robots = cell.scenario.must_end(), len(cell.seeds)
    if not how(cell).batch:
        return robots * (RUN_ALONE + ticks * TICK_ALONE)
    if not is_ideal(cell.scenario):
        return ticks * (TICK_OF_A_BATCH + robots * TICK_IMPAIRED)
    return ticks * (TICK_OF_A_BATCH + robots * TICK_IN_A_BATCH)
