"""What a run says on its topics, in the order of its times."""

import re
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from heapq import merge
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from laglab.export.ros.messages import (
    EXACT,
    Message,
    Numbers,
    header,
    odometry,
    pose_stamped,
    transform,
    twist_stamped,
)
from laglab.export.ros.topics import (
    APPLIED,
    ARRIVAL,
    ESTIMATE,
    LINK,
    MEASUREMENT,
    SENT,
    SHADOW,
    TRANSFORMS,
    TRUE,
    Topic,
)
from laglab.export.tables import Table, tables
from laglab.results.columns import Columns
from laglab.results.numbers import AXES, COVARIANCE
from laglab.results.run import Run
from laglab_gateway import Trace

ROBOT, ESTIMATED = "robot", "robot_estimate"
LATEST = 65_536
"""Ticks after which no measurement comes any more: the link's longest delay."""
ROUNDING = 1e-6
"""[s] Times this near are the same: they are sums of doubles."""
MEASURED = ("x_meas", "y_meas", "theta_meas")
APPLIED_SPEEDS = ("v", "omega")
SENT_SPEEDS = ("v_sent", "omega_sent")

Row = Mapping[str, float]


class Said(NamedTuple):
    """A message, when it was logged and when it was made [ns since the run's first tick]."""

    logged: int
    topic: Topic
    message: Message
    made: int


def said(run: Run) -> Iterator[Said]:
    """All that a run says, however long it is. Raises NoRunError."""
    every, link, arrivals = tables(run)
    streams = (_of_ticks(run, every), _of_arrivals(run, arrivals), _of_link(run, link))
    return merge(*streams, key=lambda each: each.logged)


def _of_ticks(run: Run, every: Table) -> Iterator[Said]:
    estimates = [("_est", "", ESTIMATE, ESTIMATED)]
    for name in run.scenario.estimator.compare:
        word = re.sub(r"\W", "_", name)
        estimates.append((f"_{name}", f"_{name}", SHADOW.below(word), f"robot_{word}"))
    for piece in every.pieces:
        for row in _rows(piece):
            time = _nanoseconds(row["time"])
            yield from _of_robot(time, row)
            for suffix, of_p, topic, frame in estimates:
                if at := _numbers(row, *(axis + suffix for axis in AXES)):
                    P = _numbers(row, *(name + of_p for name in COVARIANCE))
                    applied = _numbers(row, *APPLIED_SPEEDS)
                    yield Said(time, topic, odometry(time, frame, at, P, applied), time)
                    yield Said(time, TRANSFORMS, transform(time, frame, at), time)


def _of_robot(time: int, row: Row) -> Iterator[Said]:
    """Where it is, and the speeds that it was told and has in force."""
    sent, applied = _numbers(row, *SENT_SPEEDS), _numbers(row, *APPLIED_SPEEDS)
    if at := _numbers(row, *AXES):
        true = odometry(time, ROBOT, at, EXACT, applied)
        yield Said(time, TRUE, true, time)
        yield Said(time, TRANSFORMS, transform(time, ROBOT, at), time)
    for topic, speeds in ((SENT, sent), (APPLIED, applied)):
        if speeds:
            yield Said(time, topic, twist_stamped(time, ROBOT, speeds), time)


def _of_arrivals(run: Run, arrivals: Table) -> Iterator[Said]:
    """What came out of the link, and when; with a measurement, what was measured."""
    sampled = _Sampled(run.pieces())
    for piece in arrivals.pieces:
        for row in _rows(piece):
            time, delay = _nanoseconds(row["time"]), row["arrived"] - row["tick"]
            stamps = {name: row[name] for name in ("tick", "arrived", "refused")}
            message = {"header": header(time), **stamps, "delay": delay}
            yield Said(time, ARRIVAL.below(row["direction"]), message, time)
            if row["direction"] == "measurement":
                back = row["time"] - delay * run.scenario.sample_time
                if found := sampled.at(row["tick"], back):
                    made, at = found
                    yield Said(time, MEASUREMENT, pose_stamped(made, at), made)


def _of_link(run: Run, link: Table) -> Iterator[Said]:
    """What the link did to frames, when they entered."""
    for piece in link.pieces:
        for row in _rows(piece):
            time = _nanoseconds(row["tick"] * run.scenario.sample_time)
            event = {name: row[name] for name in ("tick", "frame", "copy", "size", "fate", "extra")}
            yield Said(time, LINK.below(row["direction"]), {"header": header(time), **event}, time)


class _Sampled:
    """What was measured, and when, at ticks that are not long past."""

    def __init__(self, pieces: Iterable[Trace]) -> None:
        self._coming = iter(pieces)
        self._kept: deque[Trace] = deque()

    def at(self, tick: int, time: float) -> tuple[int, Numbers] | None:
        """The time [ns] and the pose, of a tick that was at about `time` [s]; None where nothing is
        known of it."""
        self._read_up_to(time)
        for piece in self._kept:
            row = int(np.searchsorted(piece["time"], time - ROUNDING))
            if row < len(piece["tick"]) and piece["tick"][row] == tick:
                cells = {name: float(column[row]) for name, column in piece.items()}
                at = _numbers(cells, *MEASURED)
                return (_nanoseconds(cells["time"]), at) if at else None
        return None

    def _read_up_to(self, time: float) -> None:
        while not self._kept or self._kept[-1]["time"][-1] < time:
            piece = next(self._coming, None)
            if piece is None:
                return
            self._kept.append({name: piece[name].copy() for name in ("tick", "time", *MEASURED)})
            if sum(len(each["tick"]) for each in self._kept) > LATEST + len(piece["tick"]):
                self._kept.popleft()


def _rows(piece: Columns) -> Iterator[dict[str, Any]]:
    for cells in zip(*(column.tolist() for column in piece.values()), strict=True):
        yield dict(zip(piece, cells, strict=True))


def _numbers(row: Row, *names: str) -> Numbers | None:
    """These cells; None when one of them is nothing."""
    numbers = tuple(row[name] for name in names)
    return numbers if all(map(isfinite, numbers)) else None


def _nanoseconds(time: float) -> int:
    """What a real robot did before its run began is dated back to its beginning."""
    return max(0, round(time * 1e9))
