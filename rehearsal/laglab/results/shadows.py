"""Estimators that shadow a run: what they say to the record of it."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from laglab.files import whole_file
from laglab.results.columns import Lines, beside, csv_pieces, rising
from laglab.results.numbers import AXES, COVARIANCE, RmsError, deviation
from laglab.results.summary import Errors
from laglab.runs.station_side import shadow_config
from laglab.runs.staying import staying
from laglab.scenario import Scenario
from laglab_control import PluginFailedError
from laglab_gateway import Trace, csv_header, csv_lines
from laglab_station import SessionTick, ShadowRow, shadow

COLUMNS = ("tick", *AXES, *COVARIANCE)
"""Of a shadow's file: the tick, its estimate and the upper triangle of its covariance."""

Shadow = dict[str, NDArray[np.float64]]
"""An array per column."""


def shadow_file(directory: Path, name: str) -> Path:
    """Where a run keeps what the estimator `name` said."""
    return directory / f"shadow-{file_name(name)}.csv"


def file_name(name: str) -> str:
    """An estimator's name as part of a file's: not every system allows `module:Class` there."""
    return quote(name, safe="")


def shadow_rows(
    scenario: Scenario, name: str, session: Iterable[SessionTick]
) -> Iterator[ShadowRow]:
    """What the named estimator makes of the session, with the scenario's model and prior.

    Raises: ScenarioError, when there is no such estimator.
    """
    with staying():
        config = shadow_config(scenario, name)
    return _at_home(shadow(config, session, scenario.link.playout.measurement))


def _at_home(rows: Iterator[ShadowRow]) -> Iterator[ShadowRow]:
    """The same, each taken where the user stands."""
    while True:
        with staying():
            row = next(rows, None)
        if row is None:
            return
        yield row


def until_it_fails(rows: Iterable[ShadowRow], fail: Callable[[str], None]) -> Iterator[ShadowRow]:
    """All of them, or those before somebody's code failed; `fail` is told how."""
    try:
        yield from rows
    except PluginFailedError as error:
        fail(str(error))


def kept_rows(rows: Iterable[ShadowRow], path: Path) -> Iterator[ShadowRow]:
    """The same rows, each written to the file; numbers read back to the same doubles.

    Raises: ResultsError.
    """
    upper = np.triu_indices(3)
    with whole_file(path) as file:
        file.write(csv_header(COLUMNS))
        for row in rows:
            file.write(csv_lines([(row.tick, *row.x.tolist(), *row.P[upper].tolist())]))
            yield row


def collected(rows: Iterable[ShadowRow]) -> Shadow:
    """All rows, as arrays."""
    upper = np.triu_indices(3)
    cells = [[row.tick, *row.x.tolist(), *row.P[upper].tolist()] for row in rows]
    table = np.array(cells, dtype=np.float64).reshape(-1, len(COLUMNS))
    return dict(zip(COLUMNS, table.T, strict=True))


def shadow_pieces(path: Path) -> Iterator[Shadow]:
    """What `kept_rows` wrote, piece by piece; there is one at least, if without a row. Raises
    NoRunError when the file is no shadow's."""
    yield _columns([])
    yield from csv_pieces(path, COLUMNS, _columns)


def _columns(lines: Lines) -> Shadow:
    table = np.array(lines, dtype=np.float64).reshape(-1, len(COLUMNS))
    return dict(zip(COLUMNS, table.T, strict=True))


def shadowing(trace: Trace, shadow_: Shadow, name: str) -> Trace:
    """The estimates as columns of the trace, `x_NAME` and so on; NaN where nothing was said."""
    estimates = beside(trace["tick"], shadow_, "tick", AXES)
    return {f"{axis}_{name}": column for axis, column in estimates.items()}


def shadow_error(
    rows: Iterable[ShadowRow], pieces: Iterable[Trace], measurement_delay: int
) -> Errors | None:
    """RMS over the ticks >= m, both read side by side."""
    rms, coming = RmsError(), iter(rows)
    waiting = next(coming, None)
    done = 0
    for piece in pieces:
        estimates = np.full((len(piece["tick"]), 3), np.nan)
        ticks = rising(piece["tick"])
        while waiting is not None and waiting.tick <= ticks[-1]:
            estimates[int(np.searchsorted(ticks, waiting.tick))] = waiting.x
            waiting = next(coming, None)
        rms.add(deviation(piece, estimates)[max(measurement_delay - done, 0) :])
        done += len(estimates)
    for _ in coming:
        pass  # to the end: they may be written as they come
    return rms.errors()
