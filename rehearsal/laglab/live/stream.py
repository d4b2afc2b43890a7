"""What the page's process knows of the run: told whole to who comes, and piece by piece to all."""

from collections.abc import Iterator, Sequence
from typing import TypeAlias

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from laglab.live.messages import Rows
from laglab.results.columns import Columns, columns_of, joined
from laglab.results.report.tables import (
    ALARM,
    STOPPED,
    Tables,
    arrival_columns,
    losses,
    marks,
    refusals,
    tick_columns,
    timing_columns,
)
from laglab.scenario import Scenario
from laglab_gateway import ArrivalRow, ClaimRow, LinkRow, TimingRow, trace_of
from laglab_station import ESTIMATE_IS_WRONG

MOST_ROWS = 3_000
"""Rows of each table; when there are more, every other one goes."""
MOST_TEXTS = 200
DIGITS = 6
LANE_OF = {"stop": STOPPED, ESTIMATE_IS_WRONG: ALARM}
"""The lane that is marked when one of the sides says these words."""

Cells: TypeAlias = dict[str, list[float | str]]


class Piece(Struct):
    """What the page's script is told."""

    tables: dict[str, Cells]
    texts: Sequence[str]
    stopped: bool
    whole: bool = False
    """Whether it is all there is, in the place of what the page had."""
    verdict: str | None = None
    """Of a run that is over."""


def event(piece: Piece) -> bytes:
    """As server-sent event."""
    return b"data: " + msgspec.json.encode(piece) + b"\n\n"


def tables_in(rows: Rows, scenario: Scenario) -> Tables:
    """The columns behind the plots."""
    arrivals = columns_of(rows.arrivals, ArrivalRow)
    Ts = scenario.sample_time
    return Tables(
        tick_columns(trace_of(rows.trace), columns_of(rows.claims, ClaimRow), scenario.target),
        arrival_columns(arrivals, "command"),
        arrival_columns(arrivals, "measurement"),
        joined([losses(columns_of(rows.link, LinkRow), Ts), refusals(arrivals)]),
        timing_columns(columns_of(rows.timing, TimingRow), Ts),
    )


class Known:
    """All of the run so far, as much of it as a screen shows."""

    def __init__(self) -> None:
        self._tables: dict[str, Cells] = {}
        self._texts: list[str] = []
        self._time = 0.0
        self.stopped = False
        self.verdict: str | None = None

    def learn(self, rows: Rows, said: Sequence[str], scenario: Scenario) -> Piece:
        """Takes rows, and words `said` meanwhile; gives what is new for the page."""
        self._time = rows.trace[-1].time if rows.trace else self._time
        tables = tables_in(rows, scenario)
        tables = tables._replace(marks=joined([tables.marks, *self._marks(said)]))
        texts = [f"{self._time:.2f} s: {text}" for text in said]
        news = {name: _cells(columns) for name, columns in tables._asdict().items()}
        for name, cells in news.items():
            self._tables[name] = _longer(self._tables.get(name, {}), cells)
        self._texts = [*self._texts, *texts][-MOST_TEXTS:]
        self.stopped = rows.stopped
        return Piece(news, texts, rows.stopped)

    def _marks(self, said: Sequence[str]) -> Iterator[Columns]:
        for text in said:
            if lane := next((lane for word, lane in LANE_OF.items() if word in text), None):
                yield marks([self._time], lane, text)

    @property
    def whole(self) -> Piece:
        """All of it, for a reader who comes now."""
        return Piece(self._tables, self._texts, self.stopped, True, self.verdict)


def _longer(cells: Cells, more: Cells) -> Cells:
    whole = {name: cells.get(name, []) + column for name, column in more.items()}
    if len(next(iter(whole.values()))) > MOST_ROWS:
        return {name: column[::2] for name, column in whole.items()}
    return whole


def _cells(columns: Columns) -> Cells:
    return {name: _rounded(column) for name, column in columns.items()}


def _rounded(column: NDArray[np.generic]) -> list[float | str]:
    if column.dtype.kind in "OU":
        return [str(cell) for cell in column]
    return [float(f"{cell:.{DIGITS}g}") for cell in column.tolist()]
