"""A run in one figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from laglab.errors import ResultsError
from laglab.results.figures.marks import time_axis
from laglab.results.figures.panels import (
    SPEEDS,
    draw_component,
    draw_distance,
    draw_error,
    draw_shadows,
    draw_speed,
)
from laglab.results.figures.plane import draw_path
from laglab.results.figures.shown import Shown, shown
from laglab.results.figures.strip import draw_delays
from laglab.results.figures.style import INCHES, MOST_HIGH, Width, legend, printed, sheet
from laglab_gateway import DIRECTIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from laglab.results.run import Run

Row = tuple[str, ...]
"""The panels beside each other in a sixth of the width each; a name again is the same panel."""

TITLE = 0.25
HEIGHTS = {"path": 1.25, "θ": 1.1, "command": 0.8, "measurement": 0.9}
"""[inch] Of a row, by the first of its panels."""
USUAL = 1.0
LANE = 0.1
"""[inch] What each cause of losses adds."""


def title(run: Run) -> str:
    """The scenario in a line: name, filter, delays and noise."""
    scenario, summary = run.scenario, run.summary
    is_ours = summary.estimator == scenario.estimator.kind
    gist = scenario.gist if is_ours else scenario.gist_with(summary.estimator)
    return f"{scenario.name}: {gist}"


def draw_run(run: Run, width: Width = "two") -> Figure:
    """The path; x, y, θ errors with what is claimed of them (of a run without an estimate x, y, θ
    themselves); where estimators shadowed the run their errors; speeds; the link strip.

    Raises ResultsError.
    """
    if width not in INCHES:
        raise ResultsError(f"width: take one of {', '.join(INCHES)}, not {width!r}")
    told = shown(run)
    rows = _one(told) if width == "one" else _two(told)
    heights = [_height(told, row[0]) for row in rows]
    with printed():
        figure = sheet(INCHES[width], min(sum(heights) + TITLE, MOST_HIGH))
        panels = figure.subplot_mosaic([list(row) for row in rows], height_ratios=heights)
        for name, axes in panels.items():
            axes.set_label(name)
            _draw(axes, told, name, bottom=not _continues(rows, name))
        figure.align_ylabels()
        figure.suptitle(title(run))
    return figure


def _height(told: Shown, name: str) -> float:
    lanes = len(told.link.directions[name].lost) if name in DIRECTIONS else 0
    return HEIGHTS.get(name, USUAL) + LANE * lanes


def _two(told: Shown) -> list[Row]:
    """On a page's whole width: the path beside the errors."""
    third = ("θ",) * 3 if told.is_estimated else ("path",) * 3
    x, y, theta = _components(told)
    shadows = [(name,) * 2 for name in _shadows(told)]
    return [
        ("path",) * 3 + (x,) * 3,
        ("path",) * 3 + (y,) * 3,
        third + (theta,) * 3,
        *([sum(shadows, ())] if shadows else []),
        *((name,) * 6 for name in _distance(told)),
        ("v",) * 3 + ("omega",) * 3,
        *((direction,) * 6 for direction in DIRECTIONS),
    ]


def _one(told: Shown) -> list[Row]:
    """In a column: one below the other."""
    below = (*_components(told), *_shadows(told), *_distance(told), "v", "omega", *DIRECTIONS)
    return [("path",), ("path",), *((name,) for name in below)]


def _components(told: Shown) -> Sequence[str]:
    return ("error x", "error y", "error θ") if told.is_estimated else ("x", "y", "θ")


def _shadows(told: Shown) -> Sequence[str]:
    return ("shadow x", "shadow y", "shadow θ") if told.scenario.estimator.compare else ()


def _distance(told: Shown) -> Sequence[str]:
    """Of a robot that follows a path."""
    return () if told.target.path is None else ("distance",)


def _continues(rows: Sequence[Row], name: str) -> bool:
    """Whether the panel below has the same time, and says so."""
    *_, last = (number for number, row in enumerate(rows) if name in row)
    if last + 1 == len(rows) or name == "path":
        return False
    column = rows[last].index(name)
    below = rows[last + 1]
    return below[column] != "path" and below.count(below[column]) == rows[last].count(name)


def _draw(axes: Axes, told: Shown, name: str, bottom: bool) -> None:
    if name in DIRECTIONS:
        draw_delays(axes, told, name, bottom)
        return
    kind, _, component = name.rpartition(" ")
    match kind or name:
        case "path":
            draw_path(axes, told)
            return
        case "distance":
            draw_distance(axes, told)
        case "v" | "omega":
            draw_speed(axes, told, name)
        case "error":
            draw_error(axes, told, "xyθ".index(component))
        case "shadow":
            draw_shadows(axes, told, "xyθ".index(component))
        case _:
            draw_component(axes, told, "xyθ".index(name))
    if name in SPEEDS:  # whose marks the other panels name
        legend(axes)
    time_axis(axes, told, bottom)
    if component == "x":
        legend(axes, _row(axes) if kind == "shadow" else 1.0)


def _row(axes: Axes) -> float:
    """How many panels of this one's width stand in its row."""
    spec = axes.get_subplotspec()
    assert spec is not None, "it is one of a mosaic's"
    return spec.get_gridspec().ncols / len(spec.colspan)
