"""What was measured of a link, and the link.csv that makes it happen again."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from laglab.files import write_whole
from laglab.link.errors import LinkFileError
from laglab_gateway import (
    DIRECTIONS,
    LONGEST_EXTRA,
    MOST_TICKS,
    FateKind,
    LinkRow,
    TimelineError,
    read_link_log,
)

if TYPE_CHECKING:
    from laglab_gateway import Direction

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

CAME = (FateKind.DELIVERED, FateKind.LATE)
"""Fates of frames that came: one that is too late for play-out came all the same."""


@dataclass(frozen=True)
class Flow:
    """One direction: its frames in the order in which they were sent, one a tick."""

    sent: Array
    """[s] Since the first of them."""
    delay: Array
    """[s] From sending to arrival; NaN: it never came."""
    size: int
    """[byte] Of a frame, or of a datagram of several."""

    @property
    def lost(self) -> Flags:
        """Which of them never came."""
        return np.isnan(self.delay)

    @property
    def delivered(self) -> Array:
        """The delays of those that came [s]."""
        return self.delay[~self.lost]


@dataclass(frozen=True)
class MeasuredLink:
    """Both directions of a link, a frame a tick, and what is to be said of the figures."""

    command: Flow
    measurement: Flow
    interval: float
    """[s] From tick to tick."""
    notes: tuple[str, ...] = ()

    @property
    def flows(self) -> tuple[tuple[Direction, Flow], ...]:
        """By direction, commands first."""
        return ("command", self.command), ("measurement", self.measurement)


def gaps(lost: Flags) -> list[tuple[int, int]]:
    """Where frames were lost one after the other: from which, and before which."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lost, [False]]))).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def bursts(lost: Flags) -> list[int]:
    """The lengths of the losses: how many frames were lost one after the other, each time."""
    return [before - first for first, before in gaps(lost)]


def problem_of(measured: MeasuredLink) -> str | None:
    """Why no link.csv could hold it so that it can be read again; None where one can."""
    if not measured.interval > 0:
        return "its measurements have no times that go on from one to the next"
    for direction, flow in measured.flows:
        if len(flow.delay) > MOST_TICKS:
            return f"{len(flow.delay)} {direction}s, {MOST_TICKS} at most"
        wrong = flow.delivered[~((flow.delivered >= 0) & (flow.delivered <= LONGEST_EXTRA))]
        if len(wrong):
            return f"a {direction} that took {wrong[0]:g} s: not from 0 to {LONGEST_EXTRA:g} s"
        if not np.isfinite(flow.sent).all():
            return f"a {direction} of which it is not told when it was sent"
    return None


def rows_of(measured: MeasuredLink) -> Iterator[LinkRow]:
    """As a run records them: by tick. The delay is all of it, so they are for n = m = 0."""
    flows = measured.flows
    for tick in range(max(len(flow.delay) for _, flow in flows)):
        for direction, flow in flows:
            if tick < len(flow.delay):
                lost = bool(np.isnan(flow.delay[tick]))
                extra = 0.0 if lost else round(float(flow.delay[tick]), 7)
                fate = FateKind.LOST if lost else FateKind.DELIVERED
                yield LinkRow(direction, tick, 0, 0, flow.size, fate, extra)


def write_link_log(measured: MeasuredLink, path: Path) -> None:
    """Write `path`, whole or not at all. Raises ResultsError."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(LinkRow._fields)
    writer.writerows(rows_of(measured))
    write_whole(path, text.getvalue())


def read_measured(path: Path, interval: float, fixed: tuple[int, int] = (0, 0)) -> MeasuredLink:
    """A link.csv, of a measurement or of a run, a tick every `interval` [s].

    `fixed` are the delays [ticks] that it leaves out, command and measurement: a run's n and m. Of
    several frames in one tick the first that was sent counts, for what went beside it does not make
    up for it; of its copies the first that came. Raises LinkFileError.
    """
    try:
        rows = read_link_log(path)
    except TimelineError as error:
        raise LinkFileError(str(error)) from error
    command, measurement = (
        _flow(rows[name], interval, delay) for name, delay in zip(DIRECTIONS, fixed, strict=True)
    )
    if not (len(command.delay) or len(measurement.delay)):
        raise LinkFileError(f"{path}: no frames in it: an ideal link leaves no trace")
    return MeasuredLink(command, measurement, interval)


def _flow(every: list[LinkRow], interval: float, fixed: int) -> Flow:
    rows = [row for row in every if row.frame == 0]
    if not rows:
        return Flow(np.empty(0), np.empty(0), 0)
    first = rows[0].tick
    delay = np.full(max(row.tick for row in rows) - first + 1, np.nan)
    for row in rows:
        if row.fate in CAME and row.tick >= first:
            at = row.tick - first
            delay[at] = np.fmin(delay[at], row.extra + fixed * interval)
    sent = interval * np.arange(len(delay), dtype=np.float64)
    return Flow(sent, delay, max(row.size for row in rows))
