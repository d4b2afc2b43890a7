"""How every figure looks: sizes, fonts and lines for print; told apart in grey and by every eye.

Nothing is told by colour alone: what differs, differs in line style, marker or hatch too. The
colours are Okabe's and Ito's, which the colour-blind can tell apart, in an order of grey values.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Literal, NamedTuple

from laglab.results.figures.settings import load, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Width = Literal["one", "two"]
"""Of how many columns of a journal's page a figure takes the width."""
INCHES: dict[Width, float] = {"one": 3.3, "two": 7.0}
MOST_HIGH = 9.0
"""[inch] What stands on a page; rows that would be higher together are all made lower."""

BLACK, GREY, PALE = "#000000", "#6e6e6e", "#d0d0d0"
BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY = "#CC79A7", "#56B4E9"

PRINT = {
    "font.size": 7.0,
    "axes.titlesize": 7.0,
    "axes.labelsize": 7.0,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "legend.fontsize": 6.0,
    "figure.titlesize": 8.0,
    "legend.handlelength": 2.4,
    "legend.borderpad": 0.3,
    "legend.labelspacing": 0.25,
    "legend.framealpha": 0.9,
    "legend.edgecolor": PALE,
    "legend.fancybox": False,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlepad": 3.0,
    "axes.labelpad": 2.0,
    "grid.linewidth": 0.4,
    "grid.color": "#e4e4e4",
    "lines.linewidth": 0.9,
    "lines.markersize": 3.0,
    "hatch.linewidth": 0.4,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.major.pad": 2.0,
    "ytick.major.pad": 2.0,
    "pdf.fonttype": 42,
    "ps.fonttype": 42,
    "figure.constrained_layout.h_pad": 0.03,
    "figure.constrained_layout.w_pad": 0.03,
}
"""matplotlib's settings; publishers want fonts of type 42, outlines that can be searched."""


MARK, LETTER = 0.4, 0.046
"""[inch] About the width of what stands beside a name in a legend, and of each of its letters."""
LONGEST = 26
"""The most letters of a name."""


class Line(NamedTuple):
    """One of several lines in a panel."""

    color: str
    linestyle: str | tuple[int, tuple[int, ...]]
    marker: str


LINES = (
    Line(BLUE, "-", "o"),
    Line(RED, "--", "s"),
    Line(BLACK, "-.", "^"),
    Line(ORANGE, (0, (5, 1)), "D"),
    Line(GREEN, (0, (1, 1)), "v"),
    Line(PURPLE, (0, (3, 1, 1, 1, 1, 1)), "P"),
    Line(SKY, (0, (8, 2)), "X"),
)


def line(number: int) -> Line:
    """The look of the n-th of several; after the last they begin again."""
    return LINES[number % len(LINES)]


def printed() -> AbstractContextManager[None]:
    """Whatever is drawn within looks so; matplotlib is loaded here, for a side alone does
    without."""
    return plain(PRINT)


def sheet(width: float, height: float) -> Figure:
    """A figure of this size [inch] to draw on."""
    load()
    from laglab.results.figures.picture import Picture

    return Picture(figsize=(width, height), layout="constrained")


def short(name: str) -> str:
    """As a figure has room for: of a longer one the end, for that of module:Class is the class."""
    return name if len(name) <= LONGEST else f"…{name[1 - LONGEST :]}"


def legend(axes: Axes, across: float = 1.0) -> None:
    """Above the panel, where it hides nothing: of what has a name, if anything has. It may be
    `across` panels wide, if the others have none."""
    handles, names = axes.get_legend_handles_labels()
    if not names:
        return
    names = list(map(short, names))
    width = axes.get_position().width * axes.figure.get_figure(root=True).get_figwidth()
    columns = _columns(names, across * width)
    drawn = axes.legend(
        handles,
        names,
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        frameon=False,
        borderaxespad=0.1,
        columnspacing=1.0,
        handletextpad=0.5,
    )
    if across > 1:  # the panel need not be as wide as its legend, but what is above makes room
        drawn.set_in_layout(False)
        axes.set_title("\n".join(" " * -(-len(names) // columns)))


def _columns(names: Sequence[str], width: float) -> int:
    """As many as fit, filled one after the other."""
    for columns in range(len(names), 1, -1):
        rows = -(-len(names) // columns)
        parts = [names[first : first + rows] for first in range(0, len(names), rows)]
        if sum(MARK + LETTER * max(map(len, part)) for part in parts) <= width:
            return columns
    return 1
