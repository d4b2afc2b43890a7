"""The telemetry log that MAVLink ground stations write: each frame after its time of arrival."""

from collections.abc import Iterator
from pathlib import Path

from laglab_protocol.errors import ProtocolError
from laglab_protocol.framing.frame import Frame, decode

STAMP_SIZE = 8


class TlogError(ProtocolError):
    """The file is no telemetry log."""


def tlog_record(time_us: int, frame: bytes) -> bytes:
    """What the log holds of one frame. `time_us` is in microseconds, not negative."""
    return time_us.to_bytes(STAMP_SIZE, "big") + frame


def read_tlog(path: Path) -> Iterator[tuple[int, Frame]]:
    """The frames of the log with their times [us]; a record cut short at the end is left out.

    Raises TlogError where a record is no frame of the dialect.
    """
    data = Path(path).read_bytes()
    position = 0
    while position + STAMP_SIZE < len(data):
        time_us = int.from_bytes(data[position : position + STAMP_SIZE], "big")
        found = decode(data, position + STAMP_SIZE)
        if not isinstance(found, Frame):
            if found is found.INCOMPLETE:
                return
            raise TlogError(f"{path}: no frame of the dialect at byte {position + STAMP_SIZE}")
        yield time_us, found
        position += STAMP_SIZE + len(found.raw)
