"""A run's files, written while it goes on."""

import math
import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from io import FileIO
from itertools import starmap
from pathlib import Path
from time import monotonic
from typing import Generic, TypeVar

from laglab_gateway.errors import TraceError
from laglab_gateway.link.log import LinkRow
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.record.rows import ArrivalRow, ClaimRow, TimingRow
from laglab_gateway.record.text import csv_header, csv_lines
from laglab_gateway.record.trace import TraceRow
from laglab_protocol import tlog_record

TRACE_FILE = "trace.csv"
TLOG_FILE = "robot.tlog"
LINK_FILE = "link.csv"
ARRIVALS_FILE = "arrivals.csv"
CLAIMS_FILE = "claims.csv"
TIMING_FILE = "timing.csv"

TOGETHER = 8
"""Ticks that are written together, for a fraction of the cost: no more, or the station would be
ready before they are."""
PAUSE = 0.005
"""[s] After so long a tick is written alone: as a robot's are at its own pace."""

R = TypeVar("R")


class _File(Generic[R]):
    """A file, and the records that go there with the next flush."""

    def __init__(
        self, path: Path, place: Path, header: bytes, encode: Callable[[list[R]], bytes]
    ) -> None:
        """`path` is how the file is called; it lies in the folder `place`."""
        self.waiting: list[R] = []
        self._path = path
        self._encode = encode
        self._size = 0
        try:
            self._file = FileIO(place / path.name, "w")
        except OSError as error:
            raise TraceError(f"cannot record {path}: {error.strerror}") from error
        self._write(header)

    def flush(self) -> None:
        waiting, self.waiting = self.waiting, []
        if waiting and not self._file.closed:
            self._write(self._encode(waiting))

    def give_up(self) -> None:
        """From now on drop what is to be written."""
        self._file.close()

    def _write(self, data: bytes) -> None:
        """All of it or nothing: what found no room is cut off again."""
        left = memoryview(data)
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as error:
            self._cut_back()
            raise TraceError(
                f"cannot record {self._path} any further: {error.strerror}: what was written up "
                "to here is whole; make room, then run again"
            ) from error
        self._size += len(data)

    def _cut_back(self) -> None:
        with suppress(OSError):  # of a pipe, or of a device
            os.ftruncate(self._file.fileno(), self._size)


Row = TraceRow | LinkRow | ArrivalRow | ClaimRow | TimingRow
ROWS: dict[str, type[Row]] = {
    LINK_FILE: LinkRow,
    ARRIVALS_FILE: ArrivalRow,
    CLAIMS_FILE: ClaimRow,
    TIMING_FILE: TimingRow,
}
"""The rows of the files that are only made when there is something to say."""


def _csv(path: Path, place: Path, fields: tuple[str, ...]) -> _File[Row]:
    return _File(path, place, csv_header(fields), csv_lines)


class FileRecorder(Recorder):
    """Writes `trace.csv` and `robot.tlog` into a directory; `link.csv`, `arrivals.csv`,
    `claims.csv` and `timing.csv` if there is something to say.

    Records are kept until a `flush` that comes PAUSE after the last write, or finds TOGETHER ticks;
    then all of a file's go there in one unbuffered write: a process killed at any moment leaves
    whole rows and records, up to a moment before. Once one of the files cannot be written, nothing
    more is recorded.
    """

    def __init__(self, directory: Path) -> None:
        """Raises: TraceError, when the directory cannot be written."""
        self._directory = directory
        self._place = directory.absolute()  # whoever runs beside us may change the folder
        try:
            directory.mkdir(parents=True, exist_ok=True)
            for stale in ROWS:
                (directory / stale).unlink(missing_ok=True)
        except OSError as error:
            raise TraceError(f"cannot record into {directory}: {error.strerror}") from error
        self._trace = _csv(directory / TRACE_FILE, self._place, TraceRow._fields)
        self._tlog = _File[tuple[int, bytes]](
            directory / TLOG_FILE,
            self._place,
            b"",
            lambda records: b"".join(starmap(tlog_record, records)),
        )
        self._written = -math.inf
        self._others: dict[str, _File[Row]] = {}

    def row(self, row: TraceRow) -> None:
        """One more row of the trace."""
        self._trace.waiting.append(row)

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """More frames of the telemetry log."""
        self._tlog.waiting += [(time_us, frame) for frame in frames]

    def link(self, rows: Iterable[LinkRow]) -> None:
        """More rows of the link log."""
        self._keep(LINK_FILE, rows)

    def arrivals(self, rows: Iterable[ArrivalRow]) -> None:
        """What came out of the link."""
        self._keep(ARRIVALS_FILE, rows)

    def claims(self, rows: Iterable[ClaimRow]) -> None:
        """What the station claims for its estimates."""
        self._keep(CLAIMS_FILE, rows)

    def timing(self, row: TimingRow) -> None:
        """One tick's lateness."""
        self._keep(TIMING_FILE, [row])

    def _keep(self, name: str, rows: Iterable[Row]) -> None:
        if name not in self._others:
            self._others[name] = _csv(self._directory / name, self._place, ROWS[name]._fields)
        self._others[name].waiting += rows

    def flush(self) -> None:
        """Write what has been kept, unless it is little and that was done a moment ago."""
        now = monotonic()
        if now - self._written >= PAUSE or len(self._trace.waiting) >= TOGETHER:
            self._written = now
            self.write()

    def write(self) -> None:
        """Write all that has been kept, now."""
        try:
            for file in self._files:
                file.flush()
        except TraceError:
            for file in self._files:
                file.give_up()
            raise

    def close(self) -> None:
        """Write the rest, and close all files."""
        try:
            self.write()
        finally:
            for file in self._files:
                file.give_up()

    @property
    def _files(self) -> "list[_File[Row] | _File[tuple[int, bytes]]]":
        return [self._trace, self._tlog, *self._others.values()]
