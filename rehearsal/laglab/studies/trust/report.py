"""How each station fared, as a table and as a picture."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from laglab.studies.judged import LOOKED_AT_AFTER
from laglab.studies.shares import draw_shares
from laglab.studies.trust.trials import Pair
from laglab.tables import counted, plain_table

if TYPE_CHECKING:
    import pyarrow as pa
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


Scores = Mapping[Pair, Score]


def score(runs: pa.Table) -> Score:
    """Of rows of a study, with those of ALARMS."""
    squares = _known(runs, "rms_x") ** 2 + _known(runs, "rms_y") ** 2
    nees, late = _known(runs, "nees"), _known(runs, "alarm_error")
    return Score(
        runs.num_rows,
        int(np.sum(runs["converged"].to_numpy())),
        float(np.sqrt(np.mean(squares))) if len(squares) else np.nan,
        float(np.mean(nees)) if len(nees) else np.nan,
        len(_known(runs, "alarm_s")),
        float(np.mean(late < FOUND)) if len(late) else np.nan,
    )


def _known(runs: pa.Table, column: str) -> NDArray[np.float64]:
    return np.asarray(runs[column].drop_null().to_numpy(), np.float64)


def trust_table(of: Scores, stations: Sequence[str], seeds: int) -> Table:
    """Of each condition how many runs converged, a column a station; and of the first station the
    error, the NEES and the alarms."""
    table = plain_table(
        title=f"converged, of {counted(seeds, 'run')} each",
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
