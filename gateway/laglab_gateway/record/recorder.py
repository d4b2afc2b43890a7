"""The flight recorder: what happened, on disk, whole up to the last tick."""

from collections.abc import Callable, Iterable
from io import FileIO
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from laglab_gateway.errors import TraceError
from laglab_gateway.link.log import LinkRow
from laglab_gateway.record.trace import TraceRow, format_row
from laglab_protocol import tlog_record

TRACE_FILE = "trace.csv"
TLOG_FILE = "robot.tlog"
LINK_FILE = "link.csv"
TIMING_FILE = "timing.csv"


class TimingRow(NamedTuple):
    """When a tick began after its deadline [s], and when its answer came after that [s]."""

    tick: int
    lateness: float
    answer: float | None


class Recorder(Protocol):
    """Told of all that happens, as it happens."""

    def row(self, row: TraceRow) -> None:
        """One tick is over."""

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Whole frames crossed the link, either way, at `time_us` of simulation time."""

    def link(self, rows: Iterable[LinkRow]) -> None:
        """What an impaired link did to frames."""

    def timing(self, row: TimingRow) -> None:
        """One tick began, on the wall clock."""

    def flush(self) -> None:
        """Nobody waits for this side now: a good moment to write."""

    def close(self) -> None:
        """The run is over."""


class NoRecorder:
    """For a gateway that nobody asked to keep anything."""

    def row(self, row: TraceRow) -> None:
        """Forget it."""

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Forget them."""

    def link(self, rows: Iterable[LinkRow]) -> None:
        """Forget them."""

    def timing(self, row: TimingRow) -> None:
        """Forget it."""

    def flush(self) -> None:
        """There is nothing to write."""

    def close(self) -> None:
        """Nothing is open."""


class _File:
    """A file, and the records that go there with the next flush."""

    def __init__(self, path: Path, header: bytes, encode: Callable[[Any], bytes]) -> None:
        self.waiting: list[Any] = []
        self._encode = encode
        try:
            self._file = FileIO(path, "w")
        except OSError as error:
            raise TraceError(f"cannot record {path}: {error.strerror}") from error
        self._file.write(header)

    def flush(self) -> None:
        if self.waiting:
            waiting, self.waiting = self.waiting, []
            self._file.write(b"".join(map(self._encode, waiting)))

    def close(self) -> None:
        self.flush()
        self._file.close()


def _csv(path: Path, row: type[tuple[Any, ...]]) -> _File:
    header = ",".join(row._fields) + "\n"  # type: ignore[attr-defined]
    return _File(path, header.encode(), lambda values: format_row(values).encode())


class FileRecorder:
    """Writes `trace.csv` and `robot.tlog` into a directory; `link.csv` and `timing.csv` if any.

    Kept until `flush`, then all of a file's records go there in one unbuffered write: a process
    killed at any moment leaves whole rows and whole records, up to the last flush.
    """

    def __init__(self, directory: Path) -> None:
        """Raises: TraceError, when the directory cannot be written."""
        self._directory = directory
        try:
            directory.mkdir(parents=True, exist_ok=True)
            for stale in (LINK_FILE, TIMING_FILE):
                (directory / stale).unlink(missing_ok=True)
        except OSError as error:
            raise TraceError(f"cannot record into {directory}: {error.strerror}") from error
        self._trace = _csv(directory / TRACE_FILE, TraceRow)
        self._tlog = _File(directory / TLOG_FILE, b"", lambda record: tlog_record(*record))
        self._link: _File | None = None
        self._timing: _File | None = None

    def row(self, row: TraceRow) -> None:
        """One more row of the trace."""
        self._trace.waiting.append(row)

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """More frames of the telemetry log."""
        self._tlog.waiting += [(time_us, frame) for frame in frames]

    def link(self, rows: Iterable[LinkRow]) -> None:
        """More rows of the link log."""
        self._link = self._link or _csv(self._directory / LINK_FILE, LinkRow)
        self._link.waiting += rows

    def timing(self, row: TimingRow) -> None:
        """One tick's lateness."""
        self._timing = self._timing or _csv(self._directory / TIMING_FILE, TimingRow)
        self._timing.waiting.append(row)

    def _files(self) -> list[_File]:
        return [each for each in (self._trace, self._tlog, self._link, self._timing) if each]

    def flush(self) -> None:
        """Write all that has been kept."""
        for file in self._files():
            file.flush()

    def close(self) -> None:
        """Write the rest, and close all files."""
        for file in self._files():
            file.close()
