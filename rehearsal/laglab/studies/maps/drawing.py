"""The picture of a study: heat maps over two keys, or lines over one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from laglab.results.figures import plain
from laglab.scenario import Scenario, changed
from laglab.studies.maps.grid import Sorted, fields, sorted_into
from laglab.studies.maps.heat import Map, draw_maps
from laglab.studies.maps.lines import draw_lines
from laglab.studies.maps.margin import Plane, moves_it, plane
from laglab.studies.maps.measures import MeasureValues
from laglab.studies.maps.runs import Layout, StudyRuns, layout

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ALWAYS = "converged"
MEASURES = (ALWAYS, "diverged", "rms_x", "settled_s")
"""Drawn when nothing else is asked for, as far as they say something."""


def draw_study(
    runs: StudyRuns,
    values: Sequence[str] = (),
    x: str | None = None,
    y: str | None = None,
    panels: str | None = None,
) -> Figure:
    """A row of panels for each of the columns `values`, on one scale; a panel for each value of a
    third key, `panels`. Other keys are taken together, as the title says.

    Raises: StudyError, when there is no such key or column, or nothing to draw along.
    """
    chosen = layout(runs, x, y, panels)
    told = [MeasureValues.by(runs, column) for column in values] or telling(runs)
    into = sorted_into(runs, chosen)
    maps = [Map(each.of, fields(each, into)) for each in told]
    with plain():
        if chosen.y is None:
            figure = draw_lines(chosen, into, maps, _line_margin(runs, chosen))
        else:
            figure = draw_maps(chosen, into, maps, margins(runs, chosen, into))
        figure.suptitle(_title(runs, chosen))
    return figure


def telling(runs: StudyRuns) -> list[MeasureValues]:
    """What is drawn when nothing else is asked for."""
    told = (MeasureValues.by(runs, column) for column in MEASURES)
    return [each for each in told if each.of.column == ALWAYS or each.says_something]


def margins(runs: StudyRuns, chosen: Layout, into: Sorted) -> list[Plane]:
    """The delay margin for each panel; none where it is not on the map, or the runs of a cell have
    different ones."""
    x, y, key = chosen.x, chosen.y or "", chosen.panels
    if not _is_polar(runs, (x, y, key, *chosen.averaged)):
        return []
    if runs.base is None or not (moves_it(x) or moves_it(y)) or any(map(moves_it, chosen.averaged)):
        return []
    bases = [
        changed(runs.base, {key: value}) if key and moves_it(key) else runs.base
        for value in into.panels
    ]
    return [plane(base, x, into.x, y, into.y) for base in bases]


def _line_margin(runs: StudyRuns, chosen: Layout) -> Scenario | None:
    """The scenario whose margin is drawn, where one line holds for all runs."""
    others = (chosen.panels, *chosen.averaged)
    if not _is_polar(runs, (chosen.x, *others)):
        return None
    return None if any(key and moves_it(key) for key in others) else runs.base


def _is_polar(runs: StudyRuns, keys: Sequence[str | None]) -> bool:
    """Of no other law is the margin known."""
    return runs.base is not None and runs.base.law.kind == "polar" and "law.kind" not in keys


def _title(runs: StudyRuns, chosen: Layout) -> str:
    seeds = len(set(runs.columns["seed"].tolist())) if "seed" in runs.columns else 0
    total = len(runs.columns[chosen.x])
    told = f"{runs.name}: {total} runs" + (f", {seeds} seeds" if seeds > 1 else "")
    return "; ".join([told, *together(chosen)])


def together(chosen: Layout) -> list[str]:
    """Which keys are not told apart, in words; nothing if all are."""
    return [f"all of {', '.join(chosen.averaged)} together"] if chosen.averaged else []
