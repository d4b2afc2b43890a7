"""The flight recorder: what happened, on disk, whole up to the last tick."""

from collections.abc import Iterable
from io import FileIO
from pathlib import Path
from typing import NamedTuple, Protocol

from laglab_gateway.errors import TraceError
from laglab_gateway.linklog import LINK_HEADER, LinkRow
from laglab_gateway.trace import HEADER, TraceRow, format_row
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

    def close(self) -> None:
        """Nothing is open."""


class FileRecorder:
    """Writes `trace.csv` and `robot.tlog` into a directory; `link.csv` and `timing.csv` if any.

    Unbuffered, and each row or batch in one write: a process killed at any moment leaves whole
    rows and whole records.
    """

    def __init__(self, directory: Path) -> None:
        """Raises: TraceError, when the directory cannot be written."""
        self._directory = directory
        self._files: dict[str, FileIO] = {}
        try:
            directory.mkdir(parents=True, exist_ok=True)
            for stale in (LINK_FILE, TIMING_FILE):
                (directory / stale).unlink(missing_ok=True)
        except OSError as error:
            raise TraceError(f"cannot record into {directory}: {error.strerror}") from error
        self._trace = self._open(TRACE_FILE, HEADER)
        self._tlog = self._open(TLOG_FILE)

    def _open(self, name: str, header: str = "") -> FileIO:
        if name not in self._files:
            try:
                self._files[name] = FileIO(self._directory / name, "w")
            except OSError as error:
                raise TraceError(f"cannot record {name}: {error.strerror}") from error
            self._files[name].write(header.encode())
        return self._files[name]

    def row(self, row: TraceRow) -> None:
        """Append one row to the trace."""
        self._trace.write(format_row(row).encode())

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Append the frames to the telemetry log."""
        if records := b"".join(tlog_record(time_us, frame) for frame in frames):
            self._tlog.write(records)

    def link(self, rows: Iterable[LinkRow]) -> None:
        """Append the fates of frames to the link log."""
        text = "".join(format_row(row) for row in rows)
        self._open(LINK_FILE, LINK_HEADER).write(text.encode())

    def timing(self, row: TimingRow) -> None:
        """Append one tick's lateness."""
        header = ",".join(TimingRow._fields) + "\n"
        self._open(TIMING_FILE, header).write(format_row(row).encode())

    def close(self) -> None:
        """Close all files."""
        for file in self._files.values():
            file.close()
