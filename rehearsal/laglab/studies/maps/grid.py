"""The runs of a study, put into the cells of a map."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.studies.maps.measures import MeasureValues, Summed
from laglab.studies.maps.runs import Layout, StudyRuns

Array = NDArray[np.float64]


class Field(NamedTuple):
    """One panel of one measure: arrays of shape (y, x), NaN where there are no runs."""

    centre: Array
    low: Array
    high: Array
    diverged: Array
    """The share of the runs whose estimate diverged."""


class Sorted(NamedTuple):
    """Which runs are in which cell."""

    x: Sequence[object]
    y: Sequence[object]
    panels: Sequence[object]
    cells: Sequence[Sequence[Sequence[NDArray[np.intp]]]]
    """By panel, y and x: the runs' numbers."""


def sorted_into(runs: StudyRuns, by: Layout) -> Sorted:
    """By the keys of the layout; a key that is None has one value, None."""
    keys = (by.panels, by.y, by.x)
    values = [runs.values(key) if key else [None] for key in keys]
    shape = tuple(len(each) for each in values)
    places = np.zeros(len(runs.columns[by.x]), dtype=int)
    for key, of in zip(keys, values, strict=True):
        rank = {value: number for number, value in enumerate(of)}
        column = runs.columns[key].tolist() if key else [None] * len(places)
        places = places * len(of) + [rank[value] for value in column]
    order = np.argsort(places, kind="stable")
    ends = np.cumsum(np.bincount(places, minlength=int(np.prod(shape))))[:-1]
    groups = iter(np.split(order, ends))
    cells = [[[next(groups) for _ in values[2]] for _ in values[1]] for _ in values[0]]
    return Sorted(values[2], values[1], values[0], cells)


def fields(told: MeasureValues, into: Sorted) -> list[Field]:
    """Of one measure, a panel each."""
    return [
        _field([[told.summed(chosen) for chosen in row] for row in rows]) for rows in into.cells
    ]


def _field(cells: list[list[Summed]]) -> Field:
    def of(cell: Summed) -> tuple[float, ...]:
        return *cell.estimate, cell.diverged / cell.runs if cell.runs else np.nan

    table = np.array([[of(cell) for cell in row] for row in cells], dtype=float)
    return Field(*np.moveaxis(table, 2, 0))
