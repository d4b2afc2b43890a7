"""How each station fared, as a table and as a picture."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from rich.table import Table

from laglab.studies.shares import by_pair, draw_shares
from laglab.studies.trust.trials import LOOKED_AT_AFTER, Fared
from laglab.tables import plain_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FOUND = 0.05
"""[m] An estimate nearer than that has found the robot again."""


class Score(NamedTuple):
    """All seeds of one condition with one station."""

    runs: int
    converged: int
    rms: float
    """Of the estimated position [m], over all runs that had an estimate; NaN without."""
    nees: float
    """The mean over the runs; NaN where nothing was claimed."""
    alarmed: int
    """Runs with an alarm."""
    found: float
    """The share of them in which the estimate was within FOUND when it was looked at."""


Scores = Mapping[tuple[str, str], Score]
"""By condition and station."""


def scores(fared: Sequence[Fared]) -> Scores:
    """In the order in which they come."""
    pairs = by_pair(fared, lambda one: (one.condition, one.station))
    return {pair: _score(ones) for pair, ones in pairs.items()}


def _score(ones: Sequence[Fared]) -> Score:
    squares = [one.rms[0] ** 2 + one.rms[1] ** 2 for one in ones if one.rms]
    nees = [one.nees for one in ones if one.nees is not None]
    late = [one.late_error for one in ones if one.late_error is not None]
    return Score(
        len(ones),
        sum(one.converged for one in ones),
        float(np.sqrt(np.mean(squares))) if squares else np.nan,
        float(np.mean(nees)) if nees else np.nan,
        sum(one.alarmed for one in ones),
        float(np.mean(np.array(late) < FOUND)) if late else np.nan,
    )


def trust_table(of: Scores, stations: Sequence[str], seeds: int) -> Table:
    """Of each condition how many runs converged, a column a station; and of the first station the
    error, the NEES and the alarms."""
    table = plain_table(
        title=f"converged, of {seeds} runs each",
        caption=f"of {stations[0]}: root mean square error of the position [m];\n"
        "NEES (3 if its claims are true); runs with an alarm; of these, how many\n"
        f"were within {FOUND:g} m of the robot {LOOKED_AT_AFTER:g} s later",
    )
    table.add_column("", no_wrap=True)
    for name in (*stations, "RMS [m]", "NEES", "alarm", "found"):
        table.add_column(re.sub("(-|, )", r"\1\n", name), justify="right", vertical="bottom")
    for condition in dict.fromkeys(condition for condition, _ in of):
        of_these = [of[condition, station] for station in stations]
        table.add_row(condition, *(str(score.converged) for score in of_these), *_more(of_these[0]))
    return table


def _more(score: Score) -> tuple[str, ...]:
    found = "" if np.isnan(score.found) else f"{score.found:.0%}"
    return f"{score.rms:.4f}", f"{score.nees:.3g}", str(score.alarmed), found


def draw_trust(of: Scores, stations: Sequence[str]) -> Figure:
    """The share of runs that converged, a field for each condition and station."""

    def share(condition: str, station: str) -> tuple[float, str]:
        score = of[condition, station]
        return score.converged / score.runs, ""

    conditions = list(dict.fromkeys(condition for condition, _ in of))
    headings = {name: name.replace(", ", ",\n") for name in stations}
    return draw_shares("runs that end at the goal", conditions, headings, share)
