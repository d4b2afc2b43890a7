"""The data behind a page's plots, under names by which its script finds them."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from bokeh.models import ColumnDataSource
from numpy.typing import NDArray

from laglab.results.columns import Columns
from laglab.results.report.tables import Tables

EXACT = ("tick", "time", "due")
"""Columns whose numbers a float of 32 bits does not hold."""


class Sources(NamedTuple):
    """Of one run; the last four hold what is there at the time that the page looks at."""

    ticks: ColumnDataSource
    commands: ColumnDataSource
    measurements: ColumnDataSource
    marks: ColumnDataSource
    timing: ColumnDataSource
    robot: ColumnDataSource
    ellipse: ColumnDataSource
    flight: ColumnDataSource
    now: ColumnDataSource


def sources_of(tables: Tables, run: int) -> Sources:
    """Named after themselves and the run's number, as `ticks-0`."""
    data: dict[str, Mapping[str, object]] = {
        name: _small(columns) for name, columns in tables._asdict().items()
    }
    data |= {name: {"x": [], "y": []} for name in ("robot", "ellipse", "flight")}
    data["now"] = {"time": []}
    return Sources(
        *(ColumnDataSource(dict(data[name]), name=f"{name}-{run}") for name in Sources._fields)
    )


def _small(columns: Columns) -> dict[str, NDArray[np.generic] | list[str]]:
    """As exact as a screen can show."""
    return {name: _column(name, column) for name, column in columns.items()}


def _column(name: str, column: NDArray[np.generic]) -> NDArray[np.generic] | list[str]:
    if column.dtype.kind in "OU":
        return [str(cell) for cell in column]
    with np.errstate(over="ignore"):  # beyond what a screen shows
        return column.astype(np.float64 if name in EXACT else np.float32)
