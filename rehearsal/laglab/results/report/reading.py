"""From a run to what a page draws of it: as much as fits."""

from collections.abc import Callable, Iterator

import numpy as np

from laglab.results.columns import (
    Columns,
    at_ticks,
    columns_of,
    joined,
    places,
    rising,
    stride,
    thinned,
)
from laglab.results.link_view import LinkView
from laglab.results.report.tables import (
    ALARM,
    BY_ITSELF,
    EMERGENCY,
    STOPPED,
    Tables,
    arrival_columns,
    losses,
    marks,
    refusals,
    tick_columns,
    timing_columns,
)
from laglab.results.run import Run
from laglab_gateway import ARRIVALS_FILE, CLAIMS_FILE, LINK_FILE, ROWS, TIMING_FILE, Trace

MOST_MARKS = 2_000


def tables_of(run: Run, view: LinkView, most: int) -> Tables:
    """With at most `most` ticks. Raises ResultsError."""
    trace = thinned(run.drawn, stride(len(run.drawn["tick"]), most))
    every = stride(run.summary.ticks, most)
    claims = joined(_taken(run, CLAIMS_FILE, lambda each: at_ticks(each, trace["tick"])))
    scenario = run.scenario
    ticks = tick_columns(trace, claims, scenario.target, scenario.estimator.compare)
    _note_due(run, ticks)
    return Tables(
        ticks,
        joined(_taken(run, ARRIVALS_FILE, lambda each: _latest(each, "command", every))),
        joined(_taken(run, ARRIVALS_FILE, lambda each: _latest(each, "measurement", every))),
        _marks_of(run, view),
        joined(_taken(run, TIMING_FILE, lambda each: _worst(each, scenario.sample_time, every))),
    )


def _taken(run: Run, file: str, take: Callable[[Columns], Columns]) -> Iterator[Columns]:
    """What is taken of each piece, and first of an empty one, so that there is one at least."""
    yield take(columns_of([], ROWS[file]))
    for piece in run.table_pieces(file):
        yield take(piece)


def _note_due(run: Run, ticks: Trace) -> None:
    """When the command of each tick came into force; until the robot began again, if it did."""
    last = ticks["time"][len(rising(ticks["tick"])) - 1]
    for piece in run.table_pieces(ARRIVALS_FILE):
        came = arrival_columns(piece, "command")
        there, at = places(ticks["tick"], came["tick"][came["time"] <= last])
        ticks["due"][at] = came["due"][came["time"] <= last][there]


def _latest(arrivals: Columns, direction: str, every: int) -> Columns:
    came = arrival_columns(arrivals, direction)
    return _largest(came, "delay", every)


def _worst(timing: Columns, sample_time: float, every: int) -> Columns:
    return _largest(timing_columns(timing, sample_time), "late", every)


def _largest(columns: Columns, by: str, every: int) -> Columns:
    """Of `every` rows the one that is largest in `by`: a peak stays when a run is thinned."""
    rows = len(columns[by])
    if every == 1 or rows == 0:
        return columns
    starts = np.arange(0, rows, every)
    kept = [start + int(np.argmax(columns[by][start : start + every])) for start in starts]
    return {name: column[kept] for name, column in columns.items()}


def _marks_of(run: Run, view: LinkView) -> Columns:
    Ts = run.scenario.sample_time
    found = [_few(joined(_taken(run, LINK_FILE, lambda each: losses(each, Ts))))]
    found.append(_few(joined(_taken(run, ARRIVALS_FILE, refusals))))
    found.append(marks([span.start for span in view.stopped], STOPPED, BY_ITSELF))
    found.append(marks(view.emergencies, STOPPED, EMERGENCY))
    alarms = run.summary.station.alarms if run.summary.station else ()
    found.append(marks(view.alarms, ALARM, [alarm.cause for alarm in alarms]))
    return {
        name: np.concatenate([np.asarray(each[name], dtype=kind) for each in found])
        for name, kind in (("time", float), ("lane", object), ("what", object))
    }


def _few(columns: Columns) -> Columns:
    """Thinned, if there are thousands."""
    return thinned(columns, stride(len(columns["time"]), MOST_MARKS))
