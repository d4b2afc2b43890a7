"""Heat maps: a row of panels for each measure, all of a row on one scale.

Bright is good and dark is bad, in colour and in grey. What colour alone would have to say is also
written, hatched or dotted.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.figures import sheet
from laglab.studies.maps.grid import Field, Sorted
from laglab.studies.maps.labels import in_cell, key_label, panel_label, tick_labels
from laglab.studies.maps.margin import Plane
from laglab.studies.maps.marks import HALF, NOTHING, draw_border, explain, hatch_diverged, ink
from laglab.studies.maps.measures import Interval, Measure
from laglab.studies.maps.runs import Layout

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

CELL = (0.66, 0.42)
"""[inches] The least of a cell in which numbers can be read."""
LEAST, MOST = 1.8, 5.0
"""[inches] Sides of a panel."""
LETTER = 0.085
"""[inches] Of a panel's title, about."""
WIDE = 10.0
"""A ratio of values above which the scale is logarithmic."""


class Map(NamedTuple):
    """One measure, a field for each panel."""

    of: Measure
    fields: Sequence[Field]


class Look(NamedTuple):
    """How a panel is drawn."""

    of: Measure
    scale: Normalize
    colours: Colormap
    written: bool
    """Whether there is room for numbers."""

    def colour(self, value: float) -> tuple[float, float, float, float]:
        """Of a cell."""
        grey = (float(NOTHING),) * 3
        return (*grey, 1.0) if np.isnan(value) else self.colours(float(self.scale(value)))

    def ink(self, value: float) -> str:
        """What is written on it."""
        return ink(*self.colour(value)[:3])


def draw_maps(by: Layout, into: Sorted, maps: Sequence[Map], margins: Sequence[Plane]) -> Figure:
    """A row each; `by.y` is there. `margins` are one a panel, or none."""
    from matplotlib.cm import ScalarMappable

    width = min(max(len(into.x) * CELL[0], LEAST), MOST)
    height = min(max(len(into.y) * CELL[1], LEAST), MOST)
    written = width / len(into.x) > 0.9 * CELL[0] and height / len(into.y) > 0.9 * CELL[1]
    titles = [_wrapped(panel_label(by.panels, value), width) for value in into.panels]
    high = 1.3 + 0.16 * max(title.count("\n") for title in titles) + (height + 0.4) * len(maps)
    figure = sheet(1.9 + (width + 0.15) * len(into.panels), high)
    grid = figure.subplots(len(maps), len(into.panels), squeeze=False, sharex=True, sharey=True)
    for row, each in zip(grid, maps, strict=True):
        look = _look(each, written)
        for axes, field in zip(row, each.fields, strict=True):
            _draw(axes, field, look)
        for axes, margin in zip(row, margins, strict=False):
            draw_border(axes, margin)
        colours = ScalarMappable(look.scale, look.colours)
        figure.colorbar(colours, ax=list(row), label=each.of.label, pad=0.01, aspect=15)
    _name(grid, by, into, titles)
    dotted = not written and any(each.of.share for each in maps)
    explain(figure, [field for each in maps for field in each.fields], margins, dotted)
    return figure


def _wrapped(title: str, width: float) -> str:
    """In as many lines as a panel of this width [inches] needs."""
    return textwrap.fill(title, int(width / LETTER))


def _name(grid: NDArray[np.object_], by: Layout, into: Sorted, titles: Sequence[str]) -> None:
    for axes, title in zip(grid[0], titles, strict=True):
        axes.set_title(title, fontsize="medium")
    for axes in grid[-1]:
        axes.set_xlabel(key_label(by.x))
        axes.set_xticks(*tick_labels(into.x))
    for axes in grid[:, 0]:
        axes.set_ylabel(key_label(by.y or ""))
        axes.set_yticks(*tick_labels(into.y))


def _look(each: Map, written: bool) -> Look:
    """One for all panels; of what is an error or a time, small is good and so bright."""
    from matplotlib import colormaps

    colours = colormaps["cividis" if each.of.share and not each.of.bad else "cividis_r"]
    return Look(each.of, _scale(each), colours, written)


def _scale(each: Map) -> Normalize:
    from matplotlib.colors import LogNorm, Normalize

    if each.of.share:
        return Normalize(0, 1)
    known = np.concatenate([field.centre[np.isfinite(field.centre)] for field in each.fields])
    low, high = (known.min(), known.max()) if len(known) else (0.0, 1.0)
    high = high if high > low else low + max(abs(low), 1.0)
    wide = low > 0 and high > WIDE * low
    return LogNorm(low, high) if wide else Normalize(low, high)


def _draw(axes: Axes, field: Field, look: Look) -> None:
    rows, columns = field.centre.shape
    axes.set_facecolor(NOTHING)
    axes.pcolormesh(
        np.arange(columns + 1) - HALF,
        np.arange(rows + 1) - HALF,
        np.ma.masked_invalid(field.centre),
        cmap=look.colours,
        norm=look.scale,
    )
    hatch_diverged(axes, field)
    for (y, x), centre in np.ndenumerate(field.centre):
        estimate = Interval(centre, float(field.low[y, x]), float(field.high[y, x]))
        ink = look.ink(centre)
        if look.written:
            text = in_cell(estimate, look.of.share)
            ground = {"boxstyle": "square,pad=0.03", "fc": look.colour(centre), "lw": 0}
            axes.text(x, y, text, color=ink, fontsize=7, bbox=ground, ha="center", va="center")
        elif look.of.share and estimate.low < HALF < estimate.high:
            axes.plot(x, y, ".", color=ink, markersize=3)
