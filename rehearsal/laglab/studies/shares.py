"""How often something came out well: a field for each pair of what was tried."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from laglab.results.figures import INCHES, Width, printed, sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Outcome = TypeVar("Outcome")
Share = Callable[[str, str], tuple[float, str]]
"""Called with a row and a column: gives the share of the runs, and what is written below it."""


def by_pair(
    outcomes: Iterable[Outcome], pair: Callable[[Outcome], tuple[str, str]]
) -> dict[tuple[str, str], list[Outcome]]:
    """All runs of each row and column, in the order in which these come."""
    runs: dict[tuple[str, str], list[Outcome]] = {}
    for outcome in outcomes:
        runs.setdefault(pair(outcome), []).append(outcome)
    return runs


def draw_shares(
    title: str, rows: Sequence[str], columns: dict[str, str], share: Share, width: Width = "two"
) -> Figure:
    """The brighter the more; `columns` are told by the text of their heading."""
    told = [[share(row, column) for column in columns] for row in rows]
    lines = 2 if any(more for row in told for _, more in row) else 1
    with printed():
        figure = sheet(INCHES[width], 0.8 + (0.16 + 0.09 * lines) * len(rows))
        axes = figure.subplots()
        axes.grid(visible=False)
        shares = np.array([[part for part, _ in row] for row in told])
        axes.imshow(shares, cmap="cividis", vmin=0, vmax=1, aspect="auto")
        for place in np.ndindex(shares.shape):
            _write(axes, place, *told[place[0]][place[1]])
        axes.set_xticks(range(len(columns)), list(columns.values()))
        axes.set_yticks(range(len(rows)), rows)
        axes.xaxis.tick_top()
        axes.set_title(title)
    return figure


def _write(axes: Axes, place: tuple[int, ...], share: float, more: str) -> None:
    row, column = place
    ink = "black" if share > 0.5 else "white"
    text = f"{share:.0%}" + (f"\n{more}" if more else "")
    axes.text(column, row, text, ha="center", va="center", color=ink)
