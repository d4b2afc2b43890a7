"""Runs laid over each other, on equal axes."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from laglab.results.figures.panels import COMPONENTS, SPEEDS, around, marked
from laglab.results.figures.plane import draw_headings, fit, mark_ends
from laglab.results.figures.shown import Clock, Shown, clock, shown
from laglab.results.figures.strip import configured
from laglab.results.figures.style import INCHES, MOST_HIGH, Width, legend, line, printed, sheet
from laglab.scenario import Scenario
from laglab_gateway import DIRECTIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from laglab.results.run import Run

HEIGHTS = {"path": 1.2, "error": 1.0, "v": 1.0, "command": 0.9}
USUAL = 1.0
LETTERS: dict[Width, int] = {"one": 52, "two": 112}
"""In a line of the title."""
MOST_LINES = 4
NAMES = (*COMPONENTS, "error", *SPEEDS, *DIRECTIONS)


def draw_runs(runs: Sequence[Run], width: Width = "two") -> Figure:
    """The paths; x, y, θ; how far each estimate was from the robot, or from where it was measured,
    as it then says; speeds and delays. The title says in which keys the scenarios differ.

    Raises ResultsError.
    """
    told = [shown(run) for run in runs]
    names = labels(runs)
    unit = clock(max(each.time[-1] * each.clock.seconds for each in told))
    rows = _rows(width)
    heights = [HEIGHTS.get(row[0], USUAL) for row in rows]
    with printed():
        heading = _title([run.scenario for run in runs], LETTERS[width])
        high = sum(heights) + 0.25 + 0.12 * heading.count("\n")
        figure = sheet(INCHES[width], min(high, MOST_HIGH))
        panels = figure.subplot_mosaic([list(row) for row in rows], height_ratios=heights)
        for name, axes in panels.items():
            axes.set_label(name)
            _draw(axes, name, told, names, unit)
        figure.align_ylabels()
        figure.suptitle(heading)
    return figure


def labels(runs: Sequence[Run]) -> list[str]:
    """What tells the runs apart: the scenario's name, or the folder's, or a number before it."""
    scenarios = [run.scenario.name for run in runs]
    folders = [run.directory.name if run.directory else "" for run in runs]
    for names in (scenarios, folders):
        if len(set(names)) == len(names) and all(names):
            return names
    return [f"{number}: {name}" for number, name in enumerate(scenarios, start=1)]


def _title(scenarios: Sequence[Scenario], letters: int) -> str:
    """Key by key what each has, in the order of the runs."""
    from laglab.scenario.differences import differing  # it spells values as a file does

    keys = differing(scenarios)
    kinds = [key for key in keys if key.endswith(".kind")]
    told = [f"{key}: {' | '.join(keys[key])}" for key in dict.fromkeys([*kinds, *keys])]
    if len(scenarios) == 1:
        told = [f"{scenarios[0].name}: {scenarios[0].gist}"]
    lines: list[str] = []
    for kept in range(len(told), -1, -1):
        left = [f"... ({len(told)} keys differ)"] if kept < len(told) else []
        lines = textwrap.wrap("; ".join([*told[:kept], *left]) or "the same scenario", letters)
        if len(lines) <= MOST_LINES:
            break
    return "\n".join(lines)


def _rows(width: Width) -> list[tuple[str, ...]]:
    if width == "one":
        return [("path",), ("path",), *((name,) for name in NAMES)]
    x, y, theta = COMPONENTS
    return [("path", x), ("path", y), ("error", theta), (*SPEEDS,), DIRECTIONS]


def _draw(axes: Axes, name: str, told: Sequence[Shown], names: Sequence[str], unit: Clock) -> None:
    if name == "path":
        _draw_paths(axes, told, names)
        return
    for number, (each, label) in enumerate(zip(told, names, strict=True)):
        _draw_over_time(axes, name, each, unit, number, label)
    if name in COMPONENTS:
        i = COMPONENTS.index(name)
        poses = np.concatenate([each.pose[:, i] for each in told])
        around(axes, poses, *{extreme for each in told for extreme in _extremes(each.wanted[:, i])})
    starts, ends = zip(*((each.time * each.clock.seconds)[[0, -1]] for each in told), strict=True)
    axes.set_xlim(min(starts) / unit.seconds, max(*ends, max(starts) + 1e-3) / unit.seconds)
    axes.set(xlabel=unit.label, ylabel=LABELS.get(name, name))
    if name in FROM_NOTHING:
        axes.set_ylim(0, max(1.1 * axes.dataLim.y1, FROM_NOTHING[name]))
    if name == "error" and any(each.is_measured for each in told):
        legend(axes)


def _extremes(values: NDArray[np.float64]) -> tuple[float, float]:
    return float(values.min()), float(values.max())


FROM_NOTHING: Mapping[str, float] = {"error": 1e-3, **dict.fromkeys(DIRECTIONS, 1.0)}
"""What is never below 0, and how much is shown of it at least."""
LABELS: Mapping[str, str] = {
    "error": "position\nerror [m]",
    **SPEEDS,
    **{direction: f"{direction}\ndelay [ticks]" for direction in DIRECTIONS},
}


def _draw_paths(axes: Axes, told: Sequence[Shown], names: Sequence[str]) -> None:
    for number, (each, name) in enumerate(zip(told, names, strict=True)):
        look = line(number)
        pose = each.pose
        label = f"{name}, measured" if each.is_measured else name
        marked(axes, pose[:, 0], pose[:, 1], look, number, label)
        draw_headings(axes, pose[np.isfinite(pose).all(axis=1)], look.color)
    mark_ends(axes, told[0].pose[:1], told[0].target)
    fit(axes, [each.pose for each in told], told[0].target)
    legend(axes)


def _draw_over_time(
    axes: Axes, name: str, each: Shown, unit: Clock, number: int, label: str
) -> None:
    look, scale = line(number), each.clock.seconds / unit.seconds
    if name in DIRECTIONS:
        view = each.link.directions[name]
        axes.plot(
            view.time / unit.seconds,
            view.delay,
            linestyle="none",
            marker=look.marker,
            markersize=1.8,
            color=look.color,
            markerfacecolor="none",
            markeredgewidth=0.4,
            markevery=max(1, len(view.time) // 400),
            rasterized=True,
            label=label,
        )
        axes.axhline(configured(each, name), color=look.color, linewidth=0.5, linestyle=":")
        return
    values = {
        **{label_: each.pose[:, i] for i, label_ in enumerate(COMPONENTS)},
        **{speed: each.trace[speed] for speed in SPEEDS},
        "error": np.hypot(*each.error[:, :2].T),
    }[name]
    if name == "error" and each.is_measured:
        label += ", less measured"
    marked(axes, each.time * scale, values, look, number, label)
