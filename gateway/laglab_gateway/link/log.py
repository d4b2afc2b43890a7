"""`link.csv`: what was done to every frame, and how to have it done again."""

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from laglab_gateway.errors import TimelineError
from laglab_gateway.link.fates import LONGEST_EXTRA, Fate, FateKind
from laglab_gateway.link.timeline import DIRECTIONS, Direction
from laglab_gateway.record.text import whole_lines


class LinkRow(NamedTuple):
    """One copy of one frame: the tick it entered at, its number in that tick, the copy's number,
    its size [bytes], what became of it, and how much later than the fixed delay [s]."""

    direction: str
    tick: int
    frame: int
    copy: int
    size: int
    fate: str
    extra: float


LINK_HEADER = ",".join(LinkRow._fields) + "\n"


class RecordedFates:
    """The fates of another run, frame by frame. A longer run goes through them again.

    What goes into the link with a recorded frame, and has no record of its own, shares its fate:
    it was in the same datagram. Where there is no record of a tick at all, frames are delivered.
    """

    def __init__(self, rows: Sequence[LinkRow], ticks: range | None = None) -> None:
        """`ticks` are those that the record tells of, by default from the first row's to the last
        one's."""
        self._ticks = recorded_ticks(rows) if ticks is None else ticks
        self._fates: dict[int, dict[int, list[tuple[FateKind, float]]]] = {}
        for row in rows:
            frames = self._fates.setdefault(row.tick, {})
            frames.setdefault(row.frame, []).append((_done(row.fate), row.extra))
        self._tick, self._frame = -1, 0

    def of(self, tick: int, time: float, raw: bytes) -> list[Fate]:  # noqa: ARG002 the tick tells
        """As recorded for the frame of the same number in the same tick."""
        self._frame = self._frame + 1 if tick == self._tick else 0
        self._tick = tick
        return [
            Fate(kind, extra, raw if kind is FateKind.DELIVERED else b"")
            for kind, extra in self._recorded(tick)
        ]

    def _recorded(self, tick: int) -> list[tuple[FateKind, float]]:
        if self._ticks:
            tick = self._ticks[(tick - self._ticks.start) % len(self._ticks)]
        frames = self._fates.get(tick)
        if frames is None:
            return [(FateKind.DELIVERED, 0.0)]
        return frames.get(min(self._frame, max(frames)), [(FateKind.DELIVERED, 0.0)])


def recorded_ticks(*directions: Sequence[LinkRow]) -> range:
    """The ticks that the rows tell of, from the first to the last of any direction."""
    ticks = [row.tick for rows in directions for row in rows]
    return range(min(ticks), max(ticks) + 1) if ticks else range(0)


def _done(fate: str) -> FateKind:
    """What the link did: it delivered a frame that was too late for play-out."""
    kind = FateKind(fate)
    return FateKind.DELIVERED if kind is FateKind.LATE else kind


MOST_TICKS = 10_000_000
"""Of a log: a day at a hundred a second."""


def read_link_log(path: Path) -> dict[Direction, list[LinkRow]]:
    """The rows of each direction. Raises TimelineError when the file is no link log, or tells what
    no run does."""
    try:
        read = _read(path)
    except OSError as error:
        raise TimelineError(f"{path} is not a readable link log: {error.strerror}") from error
    except (ValueError, csv.Error) as error:
        raise TimelineError(f"{path} is not a readable link log: {error}") from error
    rows = {each: [row for row in read if row.direction == each] for each in DIRECTIONS}
    problem = (
        _elsewhere(read) or _unbelievable(rows["command"]) or _unbelievable(rows["measurement"])
    )
    if problem:
        raise TimelineError(f"{path} is not a link log that can be believed: {problem}")
    return rows


def _read(path: Path) -> list[LinkRow]:
    """Also as spreadsheets write it: with a mark before its first line, and empty rows."""
    with path.open(newline="", encoding="utf-8-sig") as file:
        lines = csv.reader(whole_lines(file))
        if next(lines, []) != list(LinkRow._fields):
            columns = LINK_HEADER.strip()
            raise TimelineError(f"{path} is not a link log: expected the columns {columns}")
        return [_row(cells, lines.line_num) for cells in lines if any(map(str.strip, cells))]


def _row(cells: Sequence[str], line: int) -> LinkRow:
    """Raises ValueError, with the line's number."""
    if len(cells) != len(LinkRow._fields):
        raise ValueError(f"line {line}: must have {len(LinkRow._fields)} columns")
    direction, tick, frame, copy, size, fate, extra = cells
    try:
        numbers = int(tick), int(frame), int(copy), int(size)
        return LinkRow(direction, *numbers, FateKind(fate), float(extra))
    except ValueError as error:
        raise ValueError(f"line {line}: {error}") from None


def _elsewhere(rows: Sequence[LinkRow]) -> str | None:
    """Where a row says that a frame went, if that is neither way."""
    for row in rows:
        if row.direction not in DIRECTIONS:
            return f"{_place(row)}: a direction is {' or '.join(DIRECTIONS)}"
    return None


def _unbelievable(rows: Sequence[LinkRow]) -> str | None:
    """What is wrong with the first row that cannot be; None where all can."""
    for row in rows:
        if not 0 <= row.extra <= LONGEST_EXTRA:  # nor NaN
            return f"{_place(row)}: extra must be from 0 to {LONGEST_EXTRA:g} s, not {row.extra:g}"
        if not 0 <= row.tick < MOST_TICKS:
            return f"{_place(row)}: a tick must be 0 or more and below {MOST_TICKS}"
        if min(row.frame, row.copy, row.size) < 0:
            return f"{_place(row)}: frame, copy and size must be 0 or more"
    return _uncounted(rows)


def _uncounted(rows: Sequence[LinkRow]) -> str | None:
    """Frames are counted from 0 in each tick, copies from 0 of each frame."""
    frames = {row.tick for row in rows if row.frame == 0}
    copies = {(row.tick, row.frame) for row in rows if row.copy == 0}
    for row in rows:
        if row.tick not in frames:
            return f"{_place(row)}: the frames of a tick are counted from 0"
        if (row.tick, row.frame) not in copies:
            return f"{_place(row)}: the copies of a frame are counted from 0"
    return None


def _place(row: LinkRow) -> str:
    return f"{row.direction} {row.frame} of tick {row.tick}"
