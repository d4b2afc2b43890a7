"""What on a map is neither a number nor a colour: hatching, dots, the delay margin; its legend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.studies.maps.grid import Field
from laglab.studies.maps.margin import Plane

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HALF = 0.5
SOME, ALL = "//", "xxx"
GREY = "0.5"
NOTHING = "0.88"
WIDE = 8.0
"""[inches] Of a figure below which the legend has one column."""


def ink(red: float, green: float, blue: float) -> str:
    """Black on what is bright, white on what is dark; each from 0 to 1."""
    return "black" if 0.3 * red + 0.59 * green + 0.11 * blue > HALF else "white"


class Line(NamedTuple):
    """The border of one of the law's loops."""

    style: Literal["-", "--"]
    label: str


LINES = {
    "approach": Line("-", "delay margin without prediction: on the way"),
    "hold": Line("--", "delay margin without prediction: in the goal tolerance"),
}


def hatch_diverged(axes: Axes, field: Field) -> None:
    """The cells in which estimates diverged."""
    from matplotlib.patches import Rectangle

    for (y, x), share in np.ndenumerate(field.diverged):
        if share > 0:
            corner, hatch = (x - HALF, y - HALF), ALL if share == 1 else SOME
            axes.add_patch(
                Rectangle(corner, 1, 1, fill=False, hatch=hatch, lw=0, ec=GREY, zorder=1.5)
            )


def _crosses(excess: NDArray[np.float64]) -> bool:
    """Whether the border goes through the map."""
    return bool(np.nanmin(excess, initial=0) < 0 < np.nanmax(excess, initial=0))


def draw_border(axes: Axes, margin: Plane) -> None:
    """Black on a white edge, so that it shows on every ground."""
    for excess, line in zip(margin.excess, LINES.values(), strict=True):
        if _crosses(excess):
            for color, width in (("white", 2.8), ("black", 1.4)):
                axes.contour(
                    margin.x,
                    margin.y,
                    excess,
                    levels=[0.0],
                    colors=color,
                    linewidths=width,
                    linestyles="-" if color == "white" else line.style,
                )


def explain(
    figure: Figure, fields: Sequence[Field], margins: Sequence[Plane], dotted: bool
) -> None:
    """A legend of the marks that there are, below the maps."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Artist] = [
        Line2D([], [], color="black", linestyle=line.style, label=line.label)
        for number, line in enumerate(LINES.values())
        if any(_crosses(margin.excess[number]) for margin in margins)
    ]
    diverged = np.concatenate([field.diverged.ravel() for field in fields])
    if ((diverged > 0) & (diverged < 1)).any():
        handles.append(Patch(fc="none", ec=GREY, hatch=SOME, label="some estimates diverged"))
    if (diverged == 1).any():
        handles.append(Patch(fc="none", ec=GREY, hatch=ALL, label="all estimates diverged"))
    if any(np.isnan(field.centre).any() for field in fields):
        handles.append(Patch(fc=NOTHING, ec=GREY, label="no run has a value"))
    if dotted:
        open_ = "95 % interval holds 50 %"
        handles.append(Line2D([], [], color="black", marker=".", linestyle="", label=open_))
    if handles:
        columns = 1 if figure.get_figwidth() < WIDE else 2
        figure.legend(handles=handles, loc="outside lower center", ncols=columns, fontsize="small")
