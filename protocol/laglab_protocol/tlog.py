"""The telemetry log that MAVLink ground stations write: each frame after its time of arrival."""

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from laglab_protocol.errors import TlogError
from laglab_protocol.framing.frame import START, Frame, Refusal, decode, extent

STAMP_SIZE = 8
PIECE = 1 << 20


def tlog_record(time_us: int, frame: bytes) -> bytes:
    """What the log holds of one frame. `time_us` is in microseconds, not negative."""
    return time_us.to_bytes(STAMP_SIZE, "big") + frame


def read_tlog(path: Path) -> Iterator[tuple[int, Frame]]:
    """The frames of a log of any length, with their times [us]; a record cut short at the end is
    left out, and so are messages that the dialect does not have.

    Raises TlogError when it cannot be read, or where a record is no frame.
    """
    try:
        with Path(path).open("rb") as file:
            yield from _records(file, str(path))
    except OSError as error:
        raise TlogError(f"{path} cannot be read: {error.strerror}") from error


def _records(file: BinaryIO, name: str) -> Iterator[tuple[int, Frame]]:
    buffer, before, position = b"", 0, 0
    while True:
        found = _found(buffer, position + STAMP_SIZE)
        if found is Refusal.INCOMPLETE:
            more = file.read(PIECE)
            if not more:
                return
            before, buffer, position = before + position, buffer[position:] + more, 0
            continue
        if isinstance(found, Frame):
            yield int.from_bytes(buffer[position : position + STAMP_SIZE], "big"), found
            position += STAMP_SIZE + len(found.raw)
        elif found is Refusal.UNKNOWN:
            position = extent(buffer, position + STAMP_SIZE)
        else:
            at = before + position + STAMP_SIZE
            raise TlogError(f"{name}: no frame of the dialect at byte {at}")


def _found(buffer: bytes, start: int) -> Frame | Refusal:
    """UNKNOWN only of a frame that is there to its end."""
    found = decode(buffer, start)
    if found is not Refusal.UNKNOWN:
        return found
    if buffer[start] != START:
        return Refusal.BAD_CRC
    return found if extent(buffer, start) <= len(buffer) else Refusal.INCOMPLETE
