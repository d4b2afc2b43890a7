"""From frames to what the plots need: a station alone has nothing else, and both sides say in words
what they do by themselves."""

from collections.abc import Iterable
from queue import Empty, SimpleQueue
from threading import Thread
from typing import TypeVar

from laglab.live.messages import Rows
from laglab.results.station import decoded, record_session
from laglab.scenario import Scenario
from laglab_gateway import ArrivalRow, ClaimRow, Recorder, TraceRow
from laglab_protocol import ROBOT_SYSTEM, Statustext
from laglab_station import heard

BEHIND = 30
"""Ticks beyond the link's own delay that a row waits for its measurement."""

T = TypeVar("T")


def words(frames: Iterable[bytes]) -> list[str]:
    """What the robot's side says: its own and what it passes on."""
    return [
        frame.message.text.decode(errors="replace")
        for frame in decoded(frames)
        if isinstance(frame.message, Statustext) and frame.system == ROBOT_SYSTEM
    ]


class Viewed(Recorder):
    """Makes rows of frames, in a thread of its own: who reads a session waits for its frames."""

    def __init__(self, scenario: Scenario) -> None:
        self._frames: SimpleQueue[bytes] = SimpleQueue()
        self._trace: SimpleQueue[TraceRow] = SimpleQueue()
        self._arrivals: SimpleQueue[ArrivalRow] = SimpleQueue()
        self._claims: dict[int, ClaimRow] = {}
        self._told: SimpleQueue[ClaimRow] = SimpleQueue()
        behind = scenario.link.m + BEHIND
        session = heard(decoded(iter(self._frames.get, b"")))
        Thread(
            target=record_session, args=(session, scenario.sample_time, self, behind), daemon=True
        ).start()

    def hear(self, frames: Iterable[bytes]) -> Rows:
        """Take these frames; gives the rows made of earlier ones by now."""
        for frame in frames:
            self._frames.put(frame)
        return Rows(_all(self._trace), _all(self._arrivals), _all(self._told))

    def row(self, row: TraceRow) -> None:
        """With its claim, if there is one."""
        if claim := self._claims.pop(row.tick, None):
            self._told.put(claim)
        self._trace.put(row)

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        for row in rows:
            self._arrivals.put(row)

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        self._claims |= {row.tick: row for row in rows}


def _all(queue: "SimpleQueue[T]") -> list[T]:
    found: list[T] = []
    while True:
        try:
            found.append(queue.get_nowait())
        except Empty:
            return found
