"""A run as three tables: all that is known of each tick, what the link did, what came across."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.errors import NoRunError
from laglab.results.columns import Columns, places, rising
from laglab.results.meaning import ARRIVALS, CLAIMS, LINK, SHADOW, TIMING, Column, tick_columns
from laglab.results.run import Run
from laglab_gateway import ARRIVALS_FILE, CLAIMS_FILE, LINK_FILE, TIMING_FILE, Trace

LONGEST = 2**31 - 1
"""The largest number, of seconds (68 years fit into ROS's stamps), ticks or whatever is counted."""

Keys = NDArray[np.float64]


class Table(NamedTuple):
    """One of a run's tables, to be read once, as many rows at a time as memory has room for."""

    name: str
    columns: Sequence[Column]
    rows: Iterable[Columns]
    source: str

    @property
    def pieces(self) -> Iterator[Columns]:
        """Its columns, each of the type that its unit says. Raises NoRunError."""
        for piece in self.rows:
            for column in self.columns:
                self._check(column, piece[column.name])
            yield {each.name: piece[each.name].astype(each.kind) for each in self.columns}

    def _check(self, column: Column, cells: NDArray[np.generic]) -> None:
        """Numbers that no run has would become nonsense in another format."""
        bounded = column.kind is int or column.name == "time"
        if bounded and not (np.abs(cells.astype(float)) <= LONGEST).all():
            raise NoRunError(f"{self.source}: damaged: no {column.name} is beyond {LONGEST}")

    @property
    def nothing(self) -> Columns:
        """Its columns without a row."""
        return {each.name: np.array([], dtype=each.kind) for each in self.columns}


class Tables(NamedTuple):
    """All of a run; the last two may hold no row."""

    ticks: Table
    link: Table
    arrivals: Table


def tables(run: Run) -> Tables:
    """The run's three tables, each to be read once."""
    columns = tick_columns(run.scenario.estimator.compare)
    source = str(run.directory or run.scenario.name)
    return Tables(
        Table("ticks", columns, _ticks(run), source),
        Table("link", LINK, run.table_pieces(LINK_FILE), source),
        Table("arrivals", ARRIVALS, run.table_pieces(ARRIVALS_FILE), source),
    )


def _ticks(run: Run) -> Iterator[Trace]:
    """The trace with all that is known of its ticks beside it."""
    others = [
        _Beside(run.table_pieces(CLAIMS_FILE), "time", CLAIMS[2:]),
        _Beside(run.table_pieces(TIMING_FILE), "tick", TIMING[1:]),
    ]
    for name in run.scenario.estimator.compare:
        others.append(_Beside(run.shadow_pieces(name), "tick", SHADOW[1:], f"_{name}"))
    for piece in run.pieces():
        whole = dict(piece)
        for other in others:
            whole |= other.of(piece[other.key])
        yield whole


class _Beside:
    """Another table's rows, laid beside those with the same `key`, as far as it goes up.

    A real robot that begins again counts its ticks anew: only the time goes up then.
    """

    def __init__(
        self, pieces: Iterable[Columns], key: str, columns: Iterable[Column], suffix: str = ""
    ) -> None:
        self.key = key
        self._coming = iter(pieces)
        self._renamed = {each.name: each.name + suffix for each in columns}
        self._waiting: list[Columns] = []

    def of(self, keys: Keys) -> Trace:
        """The columns for these rows; NaN where the table has none for them."""
        last = rising(keys)[-1]
        self._read_up_to(last)
        columns = {name: np.full(len(keys), np.nan) for name in self._renamed.values()}
        for piece in self._waiting:
            there, rows = places(keys, piece[self.key])
            for name, renamed in self._renamed.items():
                columns[renamed][rows] = piece[name][there]
        self._waiting = [each for each in self._waiting if each[self.key][-1] > last]
        return columns

    def _read_up_to(self, key: float) -> None:
        while not self._waiting or self._waiting[-1][self.key][-1] < key:
            piece = next(self._coming, None)
            if piece is None:
                return
            if len(piece[self.key]):
                self._waiting.append(piece)
