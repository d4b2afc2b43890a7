"""The flight recorder: what happened, on disk, whole up to the last tick."""

from collections.abc import Iterable
from pathlib import Path
from typing import Protocol

from laglab_gateway.errors import TraceError
from laglab_gateway.trace import HEADER, TraceRow, format_row
from laglab_protocol import tlog_record

TRACE_FILE = "trace.csv"
TLOG_FILE = "robot.tlog"


class Recorder(Protocol):
    """Told of every row and of every frame that crosses the link."""

    def row(self, row: TraceRow) -> None:
        """One tick is over."""

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Whole frames crossed the link, either way, at ``time_us`` of simulation time."""

    def close(self) -> None:
        """The run is over."""


class NoRecorder:
    """For a gateway that nobody asked to keep anything."""

    def row(self, row: TraceRow) -> None:
        """Forget it."""

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Forget them."""

    def close(self) -> None:
        """Nothing is open."""


class FileRecorder:
    """Writes ``trace.csv`` and ``robot.tlog`` into a directory.

    Unbuffered, and each row or batch in one write: a process killed at any moment leaves whole
    rows and whole records.
    """

    def __init__(self, directory: Path) -> None:
        """Raises: TraceError, when the directory cannot be written."""
        try:
            directory.mkdir(parents=True, exist_ok=True)
            self._trace = (directory / TRACE_FILE).open("wb", buffering=0)
            self._tlog = (directory / TLOG_FILE).open("wb", buffering=0)
        except OSError as error:
            raise TraceError(f"cannot record into {directory}: {error.strerror}") from error
        self._trace.write(HEADER.encode())

    def row(self, row: TraceRow) -> None:
        """Append one row to the trace."""
        self._trace.write(format_row(row).encode())

    def frames(self, time_us: int, frames: Iterable[bytes]) -> None:
        """Append the frames to the telemetry log."""
        if records := b"".join(tlog_record(time_us, frame) for frame in frames):
            self._tlog.write(records)

    def close(self) -> None:
        """Close both files."""
        self._trace.close()
        self._tlog.close()
