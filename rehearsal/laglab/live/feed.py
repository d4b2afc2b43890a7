"""The loop's side of a live page: a recorder that tells, and hears two orders."""

from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import NamedTuple, TypeVar

from laglab.live.messages import Caller, Line, Rows
from laglab_gateway import (
    FOLLOWED,
    ArrivalRow,
    ClaimRow,
    FateKind,
    LinkRow,
    Recorder,
    Tapped,
    TimingRow,
    TraceRow,
)
from laglab_protocol import START
from laglab_protocol.dialect.generated import laglab as mavlink

PERIOD = 0.05
"""[s] between two datagrams."""
MOST_TICKS, MOST_OTHERS = 100, 300
"""The most rows in a datagram: of the trace, and of each other table."""

MOST_FRAMES = 100
"""Of a station alone, which needs them all: what has no room goes into the next datagram."""

STATUSTEXT = mavlink.MAVLINK_MSG_ID_STATUSTEXT.to_bytes(3, "little")
"""In a frame's head."""

T = TypeVar("T")


class Controls(NamedTuple):
    """The only things that somebody at the page can do."""

    stop: Callable[[], None]
    """Stop the robot for good."""
    stopped: Callable[[], bool]
    """Whether the robot is stopped."""


class Feed(Recorder):
    """Tells the page's process what a recorder is told, some twenty times a second."""

    def __init__(self, line: Line, controls: Controls) -> None:
        self._caller = Caller(line)
        self._controls = controls
        self._rows = Rows()
        self._told = 0.0
        self._ended = False

    def row(self, row: TraceRow) -> None:
        self._rows.trace.append(row)

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        self._rows.arrivals += rows

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        self._rows.claims += rows

    def link(self, rows: Iterable[LinkRow]) -> None:
        self._rows.link += rows

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        del time_us  # the page's process has the time of the last tick
        self._rows.frames += filter(_is_text, frames)

    def timing(self, row: TimingRow) -> None:
        self._rows.timing.append(row)

    def said(self, frames: Iterable[bytes]) -> None:
        """Of a station alone: all that it heard and said."""
        self._rows.frames += frames

    def flush(self) -> None:
        """Tell, if it is time to. Raises KeyboardInterrupt when somebody at the page ends the run:
        that is what it amounts to. But once: it is said until we are gone, which may take time."""
        now = monotonic()
        if now - self._told < PERIOD:
            return
        self._told = now
        self._tell()
        match self._caller.heard():
            case "stop" if not self._controls.stopped():
                self._controls.stop()
            case "end" if not self._ended:
                self._ended = True
                raise KeyboardInterrupt

    def close(self) -> None:
        self._tell()
        self._caller.close()

    def _tell(self) -> None:
        rows, self._rows = self._rows, Rows()
        every = -(-len(rows.trace) // MOST_TICKS) or 1
        rows.trace = _last(rows.trace[::every])
        kept = {row.tick for row in rows.trace}
        rows.claims = [each for each in rows.claims if each.tick in kept]
        if every > 1:
            rows.arrivals = [each for each in rows.arrivals if _is_seen(each, kept)]
        rows.arrivals, rows.timing = _last(rows.arrivals), _last(rows.timing[::every])
        rows.link = _last([row for row in rows.link if row.fate != FateKind.DELIVERED])
        rows.stopped = self._controls.stopped()
        frames, rows.frames = rows.frames, rows.frames[:MOST_FRAMES]
        self._caller.say(rows)
        for first in range(MOST_FRAMES, len(frames), MOST_FRAMES):
            more = frames[first : first + MOST_FRAMES]
            self._caller.say(Rows(frames=more, stopped=rows.stopped))


def _is_seen(arrival: ArrivalRow, ticks: Collection[int]) -> bool:
    """One of these ticks, in either direction, and all that was refused."""
    return arrival.arrived in ticks or arrival.refused != FOLLOWED


def _is_text(frame: bytes) -> bool:
    """By its header: nothing is decoded in the loop."""
    return frame[0] == START and frame[7:10] == STATUSTEXT


def _last(rows: list[T]) -> list[T]:
    return rows[-MOST_OTHERS:]


@contextmanager
def fed(recorder: Recorder, line: str | None, controls: Controls) -> Iterator[Recorder]:
    """The recorder, tapped for a live page if there is one; the tap is gone at the end."""
    if line is None:
        yield recorder
        return
    feed = Feed(Line.read(line), controls)
    try:
        yield Tapped(recorder, feed)
    finally:
        feed.close()
