"""The picture of a study: heat maps over two keys, or lines over one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from laglab.studies.maps.grid import Sorted, fields, sorted_into
from laglab.studies.maps.heat import Map, draw_maps
from laglab.studies.maps.lines import draw_lines
from laglab.studies.maps.margin import Plane, moves_it, plane
from laglab.studies.maps.measures import Told
from laglab.studies.maps.runs import Layout, StudyRuns, layout

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MEASURES = ("converged", "rms_x", "settled_s")
"""Drawn when nothing else is asked for."""


def draw_study(
    runs: StudyRuns,
    values: Sequence[str] = MEASURES,
    x: str | None = None,
    y: str | None = None,
) -> Figure:
    """A row of panels for each of the columns `values`, on one scale; a panel for each value of a
    third key. Other keys are taken together, as the title says.

    Raises: StudyError, when there is no such key or column, or nothing to draw along.
    """
    chosen = layout(runs, x, y)
    told = [Told.by(runs, column) for column in values]
    into = sorted_into(runs, chosen)
    maps = [Map(each.of, fields(each, into)) for each in told]
    if chosen.y is None:
        figure = draw_lines(chosen, into, maps, runs.base)
    else:
        figure = draw_maps(chosen, into, maps, _margin(runs, chosen, into))
    figure.suptitle(_title(runs, chosen))
    return figure


def _margin(runs: StudyRuns, chosen: Layout, into: Sorted) -> Plane | None:
    x, y = chosen.x, chosen.y
    if runs.base is None or y is None or not (moves_it(x) or moves_it(y)):
        return None
    return plane(runs.base, x, into.x, y, into.y)


def _title(runs: StudyRuns, chosen: Layout) -> str:
    seeds = len(set(runs.columns["seed"].tolist())) if "seed" in runs.columns else 0
    total = len(runs.columns[chosen.x])
    told = f"{runs.name}: {total} runs" + (f", {seeds} seeds" if seeds > 1 else "")
    if chosen.averaged:
        told += f"; all of {', '.join(chosen.averaged)} together"
    return told
