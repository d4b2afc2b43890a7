"""A run that is over, however it was made."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from laglab.errors import NoRunError, ResultsError
from laglab.extras import DRAWING, FRAMES, require
from laglab.results.columns import (
    Columns,
    at_ticks,
    column_pieces,
    columns_of,
    joined,
    read_columns,
    stride,
    thinned,
)
from laglab.results.figures import Width, draw_run
from laglab.results.shadows import Shadow, shadow_file, shadow_pieces, shadowing
from laglab.results.summary import SUMMARY_FILE, Summary, read_summary
from laglab.scenario import Overrides, Scenario, load
from laglab_gateway import (
    ARRIVALS_FILE,
    CLAIMS_FILE,
    LINK_FILE,
    ROWS,
    TIMING_FILE,
    TRACE_FILE,
    Trace,
    TraceError,
    trace_pieces,
)

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

SCENARIO_FILE = "scenario.toml"
MOST_DRAWN = 20_000
"""Rows: more than that no figure shows."""


@contextmanager
def _as_ours() -> Iterator[None]:
    """What a trace cannot be read for, as any other table."""
    try:
        yield
    except TraceError as error:
        raise NoRunError(str(error)) from error


class Kept(NamedTuple):
    """All that was recorded of a run, in memory."""

    trace: Trace
    tables: Mapping[str, Columns]
    """By the name of the file in which each would be."""
    shadows: Mapping[str, Shadow]


@dataclass(frozen=True, eq=False)
class Run:
    """What a run leaves. SI units; one entry a tick in every column of `trace`.

    `trace["x"]`, `trace["y"]`, `trace["theta"]` is the true pose [m, m, rad] (NaN of a real robot),
    `x_meas` … the sensor's sample, `x_est` … the estimate in the loop, `v_sent`, `omega_sent` the
    command sent, `v`, `omega` the speeds in force [m/s, rad/s]; `x_NAME` … is what the estimator
    NAME, which shadowed the loop, said. NaN where there was nothing.
    """

    scenario: Scenario
    summary: Summary
    directory: Path | None
    """Where its files are; None: it was kept in memory alone."""
    kept: Kept | None = field(default=None, repr=False)

    @cached_property
    def trace(self) -> Trace:
        """All columns, each of shape (ticks + 1,). Raises NoRunError."""
        trace = joined(self.pieces())
        for name in self.scenario.estimator.compare:
            trace = trace | shadowing(trace, self.shadow(name), name)
        return trace

    @cached_property
    def link(self) -> Columns:
        """What an impaired link did: a row for each copy of each frame, columns as in link.csv.

        Raises NoRunError.
        """
        return self.table(LINK_FILE)

    @cached_property
    def arrivals(self) -> Columns:
        """When each measurement and each command came, columns as in arrivals.csv: its delay is
        `arrived` - `tick` [ticks]. Raises NoRunError."""
        return self.table(ARRIVALS_FILE)

    @cached_property
    def claims(self) -> Columns:
        """The covariance that the station claims for its estimates, columns as in claims.csv.

        Raises NoRunError.
        """
        return self.table(CLAIMS_FILE)

    @cached_property
    def timing(self) -> Columns:
        """How late each tick on the wall clock began and was answered [s]. Raises NoRunError."""
        return self.table(TIMING_FILE)

    def table_pieces(self, name: str) -> Iterator[Columns]:
        """The rows of one of these files, as many at a time as memory always has room for."""
        if self.kept:
            return iter([self.kept.tables[name]])
        return column_pieces(self._file(name), ROWS[name])

    def figure(self, width: Width = "two") -> Figure:
        """The run as a picture, as wide as one column of a page or as two, to be shown or saved.

        Raises MissingExtraError without matplotlib, and ResultsError, NoRunError.
        """
        require(DRAWING)
        return draw_run(self, width)

    @property
    def alarms(self) -> list[int]:
        """The ticks at which the estimate was found to be wrong; the first hundred at most."""
        station = self.summary.station
        return [alarm.tick for alarm in station.alarms] if station else []

    @property
    def emergencies(self) -> list[int]:
        """The ticks at which somebody stopped the robot for good: as the robot counts them, or by
        when a station alone was told."""
        link, station = self.summary.link, self.summary.station
        told = station.emergency_tick if station else None
        if link or told is None:
            return link.emergency_ticks if link else []
        return [told]

    @cached_property
    def drawn(self) -> Trace:
        """As much of the trace as a figure shows."""
        if self.kept or self._is_short:
            return thinned(self.trace, stride(len(self.trace["tick"]), MOST_DRAWN))
        return self._read_thinned()

    def drawn_table(self, name: str) -> Columns:
        """As much of the rows of one of the other files as a figure shows."""
        pieces = (thinned(each, self.stride) for each in self.table_pieces(name))
        return joined([columns_of([], ROWS[name]), *pieces])

    @property
    def stride(self) -> int:
        """Of how many rows a figure shows one."""
        return stride(self.summary.ticks, MOST_DRAWN)

    @cached_property
    def first_tick(self) -> int:
        """The number of the first tick: a real robot may begin at any."""
        return int(next(self.pieces())["tick"][0])

    def to_pandas(self) -> pandas.DataFrame:
        """The trace, a row a tick, indexed by `tick`. Raises MissingExtraError without pandas, and
        as `trace`."""
        require(FRAMES)
        import pandas

        frame = pandas.DataFrame(dict(self.trace))
        return frame.astype({"tick": int}).set_index("tick")

    def pieces(self) -> Iterator[Trace]:
        """The trace, as many rows at a time as memory always has room for. Raises NoRunError."""
        if self.kept:
            yield self.kept.trace
            return
        end = np.nan
        with _as_ours():
            for piece in trace_pieces(self._folder / TRACE_FILE):
                yield piece
                end = float(piece["time"][-1])
        self._must_end(end)

    def _must_end(self, end: float) -> None:
        """Raises NoRunError: the trace ends [s] elsewhere than the run did."""
        Ts, ticks = self.scenario.sample_time, self.summary.ticks
        if not abs(end / Ts - ticks) < 0.5:
            raise NoRunError(
                f"{self._folder / TRACE_FILE} ends after {end:g} s, the run had {ticks} ticks of "
                f"{Ts:g} s, says {SUMMARY_FILE}: it was cut off since, or is another run's"
            )

    def table(self, name: str) -> Columns:
        """All rows of one of these files. Raises NoRunError."""
        return self.kept.tables[name] if self.kept else read_columns(self._file(name), ROWS[name])

    def shadow(self, name: str) -> Shadow:
        """All that an estimator said that shadowed the run. Raises NoRunError."""
        return joined(self.shadow_pieces(name))

    def shadow_pieces(self, name: str) -> Iterator[Shadow]:
        """What an estimator said that shadowed the run, as many rows at a time as memory always has
        room for. Raises NoRunError."""
        if self.kept:
            return iter([self.kept.shadows[name]])
        return shadow_pieces(self._file(shadow_file(self._folder, name).name))

    def _file(self, name: str) -> Path:
        """Where it is. Raises NoRunError: it was cut off since. Of a run that was cut short itself
        the system may have written a part of a line."""
        path = self._folder / name
        if self.summary.outcome is not None and not _ends_in_whole(path):
            raise NoRunError(f"{path} ends within a line: it was cut off since")
        return path

    @property
    def _folder(self) -> Path:
        if self.directory is None:
            raise ResultsError("this run was kept in memory alone: it has no files")
        return self.directory

    @property
    def _is_short(self) -> bool:
        return self.summary.ticks <= MOST_DRAWN

    def _read_thinned(self) -> Trace:
        """Read so that what is not drawn is never in memory together."""
        whole = joined(thinned(each, self.stride) for each in self.pieces())
        for name in self.scenario.estimator.compare:
            shadow = joined(at_ticks(each, whole["tick"]) for each in self.shadow_pieces(name))
            whole |= shadowing(whole, shadow, name)
        return whole


def _ends_in_whole(path: Path) -> bool:
    """Whether its last line has an end, if the file is there and has one."""
    try:
        with path.open("rb") as file:
            file.seek(-1, os.SEEK_END)
            return file.read() == b"\n"
    except OSError:  # who reads it tells of it
        return True


def open_run(directory: str | Path) -> Run:
    """What an earlier run left in a folder; its tables are read when they are asked for.

    Raises: ResultsError, ScenarioError.
    """
    folder = Path(directory)
    summary = read_summary(folder)
    if not (folder / SCENARIO_FILE).is_file():
        raise NoRunError(f"{folder / SCENARIO_FILE} is not there: a run leaves one")
    scenario = kept_scenario(folder)
    for key, said, ran in _told_twice(scenario, summary):
        if said != ran:
            raise NoRunError(
                f"{folder / SCENARIO_FILE}: {key} is {said}, but {ran} ran, says {SUMMARY_FILE}: "
                "it was cut off or changed since"
            )
    return Run(scenario, summary, folder)


def kept_scenario(folder: Path, overrides: Overrides | None = None) -> Scenario:
    """That of the run whose files are in the folder, but for `overrides`.

    Raises: ScenarioError, as `load`; NoRunError: the file says nothing, as no run leaves it.
    """
    path = folder / SCENARIO_FILE

    def refuse(_: str) -> None:
        raise NoRunError(f"{path} says nothing of what ran: it was emptied since")

    return load(str(path), overrides, refuse)


def _told_twice(scenario: Scenario, summary: Summary) -> Iterator[tuple[str, object, object]]:
    """What the scenario says and what ran; a side alone does not know all of the other."""
    if summary.side != "robot":
        yield "estimator.kind", scenario.estimator.kind, summary.estimator
        yield "law.kind", scenario.law.kind, summary.law
    yield "link.command_delay", scenario.link.n, summary.n
    yield "link.measurement_delay", scenario.link.m, summary.m
    yield "seed", scenario.seed, summary.seed
