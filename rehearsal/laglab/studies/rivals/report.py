"""How the rivals fared, as a table and as a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from rich.table import Table

from laglab.results.figures import Width
from laglab.studies.rivals.trials import Fared
from laglab.studies.shares import by_pair, draw_shares
from laglab.tables import plain_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NOTHING = "-"


class Score(NamedTuple):
    """All seeds of one strategy on one link."""

    runs: int
    converged: int
    settled: float
    """[s] The median of the runs that settled; NaN: none did."""
    rms: float
    """[m] Over all runs; NaN: nothing was estimated."""
    driven: float
    """[m] The median."""

    @property
    def share(self) -> float:
        """Of the runs that converged."""
        return self.converged / self.runs


Scores = Mapping[tuple[str, str], Score]
"""By link and strategy."""


def scores(outcomes: Sequence[Fared]) -> Scores:
    """Of all that there are."""
    pairs = by_pair(outcomes, lambda one: (one.link, one.strategy))
    return {pair: _score(ones) for pair, ones in pairs.items()}


def _score(ones: Sequence[Fared]) -> Score:
    settled = [one.settled for one in ones if one.settled is not None]
    squares = [one.rms**2 for one in ones if one.rms is not None]
    return Score(
        len(ones),
        sum(one.converged for one in ones),
        float(np.median(settled)) if settled else np.nan,
        float(np.sqrt(np.mean(squares))) if squares else np.nan,
        float(np.median([one.driven for one in ones])),
    )


def rivals_table(title: str, of: Scores, links: Sequence[str], strategies: Sequence[str]) -> Table:
    """A line for each strategy, link by link."""
    table = plain_table(
        title=title,
        caption="settled: median of the runs that did;\n"
        "RMS: of the estimated position, over all runs;\n"
        "driven: the way that the robot went, median",
    )
    table.add_column("link", no_wrap=True)
    table.add_column("strategy", no_wrap=True)
    for heading in ("converged", "settled [s]", "RMS [m]", "driven [m]"):
        table.add_column(heading, justify="right")
    for link in links:
        for number, strategy in enumerate(strategies):
            score = of[link, strategy]
            cells = (
                f"{score.share:.0%}",
                _told(score.settled),
                _told(score.rms),
                _told(score.driven),
            )
            table.add_row("" if number else link, strategy, *cells)
        if link != links[-1]:
            table.add_row()
    return table


def _told(value: float) -> str:
    return NOTHING if np.isnan(value) else f"{value:.3g}"


def draw_rivals(
    title: str, of: Scores, links: Sequence[str], strategies: Sequence[str], width: Width = "two"
) -> Figure:
    """A field for each link and strategy: the share of runs that converge, and how soon."""

    def share(link: str, strategy: str) -> tuple[float, str]:
        score = of[link, strategy]
        return score.share, "" if np.isnan(score.settled) else f"{score.settled:.1f} s"

    headings = {strategy: strategy.replace("-", "-\n") for strategy in strategies}
    said = f"{title}: share that settled, and when in the median"
    return draw_shares(said, links, headings, share, width)
