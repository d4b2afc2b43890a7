"""The picture of a study over one key: a line for each value of another one, with its interval."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from laglab.results.figures import sheet
from laglab.scenario import Scenario
from laglab.studies.maps.grid import Sorted
from laglab.studies.maps.heat import WIDE, Map
from laglab.studies.maps.labels import key_label, panel_label, value_label
from laglab.studies.maps.margin import DELAYS, excess
from laglab.studies.maps.marks import LINES
from laglab.studies.maps.runs import Layout

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STROKES = ("o-", "s--", "^-.", "v:", "D-", "P--")
"""So that lines differ in more than colour."""


def draw_lines(by: Layout, into: Sorted, maps: Sequence[Map], base: Scenario | None) -> Figure:
    """A panel for each measure, one below the other."""
    figure = sheet(7, 0.6 + 2.6 * len(maps))
    panels = figure.subplots(len(maps), 1, squeeze=False, sharex=True)[:, 0]
    for axes, each in zip(panels, maps, strict=True):
        _draw(axes, by, into, each)
        if base is not None and by.x in DELAYS:
            _mark_margin(axes, base, by.x)
    handles, names = panels[0].get_legend_handles_labels()
    if names:
        figure.legend(handles, names, loc="outside lower center", ncols=2, fontsize="small")
    if all(map(_is_number, into.x)) and _is_wide(np.array(into.x, dtype=float)):
        panels[-1].set_xscale("log")
    panels[-1].set_xlabel(key_label(by.x))
    return figure


def _draw(axes: Axes, by: Layout, into: Sorted, each: Map) -> None:
    numeric = all(map(_is_number, into.x))
    places = np.array(into.x if numeric else range(len(into.x)), dtype=float)
    if not numeric:
        axes.set_xticks(places, [value_label(value) for value in into.x])
    for number, (field, value, stroke) in enumerate(
        zip(each.fields, into.panels, cycle(STROKES), strict=False)
    ):
        centre, low, high = (values[0] for values in field[:3])
        shift = 0.0 if numeric else 0.08 * number
        axes.errorbar(
            places + shift,
            centre,
            yerr=(centre - low, high - centre),
            fmt=stroke if numeric else stroke[0],
            capsize=2,
            label=panel_label(by.panels, value) or None,
        )
    _scale(axes, each)
    axes.set_ylabel(each.of.label, fontsize="small")
    axes.grid(alpha=0.3)


def _scale(axes: Axes, each: Map) -> None:
    known = np.concatenate([field.centre[np.isfinite(field.centre)] for field in each.fields])
    if each.of.share:
        axes.set_ylim(-0.03, 1.03)
    elif _is_wide(known):
        axes.set_yscale("log")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_wide(values: NDArray[np.float64]) -> bool:
    return len(values) > 0 and 0 < WIDE * values.min() < values.max()


def _mark_margin(axes: Axes, base: Scenario, x: str) -> None:
    """Where the excess, which grows by a tick a tick, would be 0."""
    for over, line in zip(
        excess(base, x, np.zeros(1), "", np.zeros(1)), LINES.values(), strict=True
    ):
        if np.isfinite(over[0, 0]) and over[0, 0] < 0:
            axes.axvline(-over[0, 0], color="black", linestyle=line.style, lw=1, label=line.label)
