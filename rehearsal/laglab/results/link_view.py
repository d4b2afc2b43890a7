"""What the link did in a run, as a picture shows it: delays, losses, outages, and what followed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.columns import Columns
from laglab_gateway import ARRIVALS_FILE, DIRECTIONS, FOLLOWED, LINK_FILE, Direction, FateKind
from laglab_gateway.drive import Rejection

if TYPE_CHECKING:
    from laglab.results.run import Run

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
INCOMPLETE = Rejection.INCOMPLETE.value
"""Of such a command it is not known when it would have come."""
SILENT = 20
"""[ticks] When nothing gets through for so long it is an outage, whatever the record calls it."""


class Span(NamedTuple):
    """From when to when [s] since the run's first tick."""

    start: float
    end: float


@dataclass
class DirectionView:
    """One direction of the link; of a long run as much as can be seen."""

    time: Array = field(default_factory=lambda: np.empty(0))
    """When something came out of the link [s]."""
    delay: Array = field(default_factory=lambda: np.empty(0))
    """How long after its stamp [ticks]; of a long run each stretch's shortest and longest."""
    lost: dict[str, Array] = field(default_factory=dict)
    """By cause: when something went into the link and was lost, or came and was refused [s]."""
    counts: dict[str, int] = field(default_factory=dict)
    """By cause: how many, drawn or not."""
    outages: list[Span] = field(default_factory=list)
    """When nothing that went in got through."""


class LinkView(NamedTuple):
    """Both directions, and what became of the robot and of the estimate."""

    directions: Mapping[Direction, DirectionView]
    stopped: list[Span]
    """When the robot stopped by itself, until it followed a command again."""
    emergencies: list[float]
    """When somebody stopped it for good [s]."""
    alarms: list[float]
    """When the estimate was found to be wrong [s]."""

    @property
    def outages(self) -> list[Span]:
        """Of either direction."""
        return [span for each in self.directions.values() for span in each.outages]


def link_view(run: Run) -> LinkView:
    """Of any run, read piece by piece. Raises ResultsError."""
    first, end = run.first_tick, run.summary.ticks * run.scenario.sample_time

    def times(ticks: Iterable[int]) -> list[float]:
        return [(tick - first) * run.scenario.sample_time for tick in ticks]

    link = run.summary.link
    came = _Arrivals(run.stride, times(link.failsafe_stops if link else ()))
    for piece in run.table_pieces(ARRIVALS_FILE):
        came.add(piece)
    went = _Losses(run.stride, run.scenario.sample_time)
    for piece in run.table_pieces(LINK_FILE):
        went.add(piece)
    views = {name: DirectionView() for name in DIRECTIONS}
    for name, view in views.items():
        view.time, view.delay = came.delays(name)
        view.lost = went.lost(name) | came.refused(name)
        view.counts = went.counts[name] | (came.counts if name == "command" else {})
        view.outages = went.outages(name)
    stopped = [Span(at, min(until, end)) for at, until in came.stops.items()]
    return LinkView(views, stopped, times(run.emergencies), times(run.alarms))


class _Arrivals:
    """What came out of the link, and whether the robot followed it."""

    def __init__(self, stride: int, stops: Iterable[float]) -> None:
        self._stride = stride
        self._came: dict[str, list[Array]] = {name: [] for name in DIRECTIONS}
        self._refused: dict[str, list[Array]] = {}
        """When commands were refused [s], by reason."""
        self.counts = Counter[str]()
        """How many were, by reason."""
        self.stops = dict.fromkeys(stops, np.inf)
        """When the robot stopped, and when it went on."""

    def add(self, piece: Columns) -> None:
        for name, kept in self._came.items():
            rows = (piece["direction"] == name) & (piece["refused"] != INCOMPLETE)
            time, came, stamp = (
                piece[column][rows].astype(float) for column in ("time", "arrived", "tick")
            )
            table = np.stack([time, came - stamp])
            kept.append(_extremes(table, self._stride))
        time, refused = piece["time"].astype(float), piece["refused"]
        self.counts.update(why for why in refused.tolist() if why != FOLLOWED)
        for why in set(self.counts) & set(refused.tolist()):
            self._refused.setdefault(why, []).append(time[refused == why][:: self._stride])
        followed = time[(piece["direction"] == "command") & (refused == FOLLOWED)]
        for at, until in self.stops.items():
            again = int(np.searchsorted(followed, at, side="right"))
            if again < len(followed):
                self.stops[at] = min(until, float(followed[again]))

    def delays(self, direction: Direction) -> Array:
        """Times and delays."""
        return np.concatenate([np.empty((2, 0)), *self._came[direction]], axis=1)

    def refused(self, direction: Direction) -> dict[str, Array]:
        """Times [s], by reason; only commands are refused."""
        there = self._refused if direction == "command" else {}
        return {why: np.concatenate(times) for why, times in sorted(there.items())}


class _Losses:
    """What did not get through the link."""

    def __init__(self, stride: int, sample_time: float) -> None:
        self._stride = stride
        self._sample_time = sample_time
        self._lost: dict[tuple[str, str], list[Array]] = {}
        self.counts = {name: Counter[str]() for name in DIRECTIONS}
        """Frames lost, by cause."""
        self._silences = {name: _Silences(sample_time) for name in DIRECTIONS}

    def add(self, piece: Columns) -> None:
        for name in DIRECTIONS:
            rows = piece["direction"] == name
            ticks, fates = piece["tick"][rows].astype(float), piece["fate"][rows]
            self._silences[name].add(ticks, fates != FateKind.DELIVERED, fates == FateKind.OUTAGE)
            self.counts[name].update(fate for fate in fates.tolist() if fate != FateKind.DELIVERED)
            for cause in set(self.counts[name]) & set(fates.tolist()):
                times = ticks[fates == cause][:: self._stride] * self._sample_time
                self._lost.setdefault((name, cause), []).append(times)

    def lost(self, direction: Direction) -> dict[str, Array]:
        """Times, by cause."""
        return {
            cause: np.concatenate(times)
            for (name, cause), times in sorted(self._lost.items())
            if name == direction
        }

    def outages(self, direction: Direction) -> list[Span]:
        """When nothing got through."""
        return self._silences[direction].spans()


class _Silences:
    """When one frame after the other was lost."""

    def __init__(self, sample_time: float) -> None:
        self._sample_time = sample_time
        self._over: list[Span] = []
        self._last: tuple[float, float, bool] | None = None
        """The first and the last tick of the one that is not over, and whether it is announced."""

    def add(self, ticks: Array, lost: Flags, announced: Flags) -> None:
        """More frames; `announced` are those that an outage of the link took."""
        changes = np.flatnonzero(np.diff(lost)) + 1
        for rows in np.split(np.arange(len(ticks)), changes):
            if not len(rows):
                continue
            if not lost[rows[0]]:
                self._over, self._last = self.spans(), None
                continue
            first, told = float(ticks[rows[0]]), bool(announced[rows].any())
            if self._last is not None:
                first, told = self._last[0], told or self._last[2]
            self._last = first, float(ticks[rows[-1]]), told

    def spans(self) -> list[Span]:
        """Those that were announced or are long."""
        if self._last is None:
            return self._over
        first, last, announced = self._last
        span = Span(first * self._sample_time, (last + 1) * self._sample_time)
        return [*self._over, span] if announced or last + 1 - first >= SILENT else self._over


def _extremes(table: Array, stride: int) -> Array:
    """Of every `stride` columns the two where the second row is least and greatest."""
    whole = table.shape[1] // stride * stride
    if stride == 1 or not whole:
        return table
    stretches = table[1, :whole].reshape(-1, stride)
    begins = np.arange(0, whole, stride)
    ends = (begins + stretches.argmin(axis=1), begins + stretches.argmax(axis=1))
    return table[:, np.unique(np.concatenate(ends))]
