"""What a file is, by what is in it."""

import gzip
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from laglab.link.errors import LinkFileError
from laglab.link.importing.conversations import read_capture, read_log
from laglab.link.importing.how import How
from laglab.link.importing.irtt import read_irtt
from laglab.link.importing.mahimahi import is_trace, read_mahimahi
from laglab.link.importing.ping import is_ping, read_ping
from laglab.link.importing.tables import numbers_of
from laglab.link.measured import MeasuredLink, problem_of
from laglab.link.resampling import resampled, ticks_in
from laglab_gateway import MOST_TICKS, LinkRow

GZIP = b"\x1f\x8b"
CAPTURES = tuple(
    bytes.fromhex(magic) for magic in ("a1b2c3d4", "d4c3b2a1", "a1b23c4d", "4d3cb2a1", "0a0d0d0a")
)
"""pcap in both orders, with micro- or nanoseconds; pcapng."""
FRAME_START, FRAME_AT = 0xFD, 8
HEADING = ",".join(LinkRow._fields)
MOST_BYTES = 256 * 2**20
"""[byte] The most that a file may hold, unpacked."""


def read_link(path: Path, how: How) -> MeasuredLink:
    """What the file tells of a link, in ticks of `how.interval`, or one a measurement.

    Raises LinkFileError: nothing is known in it, or what it is cannot be read; MissingExtraError.
    """
    measured = _read(path, how)
    if (problem := problem_of(measured)) is not None:
        raise LinkFileError(f"{path}: {problem}")
    if how.interval is None:
        return measured
    if (ticks := ticks_in(measured, how.interval)) > MOST_TICKS:
        raise LinkFileError(
            f"{path}: {ticks:.3g} ticks of {how.interval:g} s, {MOST_TICKS} at most: give a longer "
            "--interval"
        )
    return resampled(measured, how.interval)


def _bytes_of(path: Path) -> bytes:
    """Unpacked. Raises LinkFileError."""
    try:
        with path.open("rb") as file:
            packed = file.read(len(GZIP)) == GZIP
        with gzip.open(path) if packed else path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise LinkFileError(f"{path} cannot be read: {error}") from error
    if len(data) > MOST_BYTES:
        raise LinkFileError(f"{path}: more than {MOST_BYTES >> 20} MB: give a part of it")
    return data


class _Kind(NamedTuple):
    called: str
    read: Callable[[], MeasuredLink]
    option: str = ""
    """That is for files of this kind alone."""


def _read(path: Path, how: How) -> MeasuredLink:
    kind = _kind(_bytes_of(path), path, how)
    for option, value in (("--clocks-within", how.within), ("--back", how.back)):
        if value is not None and option != kind.option:
            raise LinkFileError(f"{path} is {kind.called}, for which {option} is not: leave it out")
    return kind.read()


def _kind(data: bytes, path: Path, how: How) -> _Kind:
    if data.startswith(CAPTURES):
        return _Kind("a capture", lambda: read_capture(path, how))
    if len(data) > FRAME_AT and data[FRAME_AT] == FRAME_START:
        return _Kind("a telemetry log", lambda: read_log(path, how))
    if data.lstrip().startswith(b"{"):
        return _Kind("irtt's JSON", lambda: read_irtt(data, how, str(path)), "--clocks-within")
    return _kind_of_text(data.decode("utf-8", errors="replace"), path, how)


def _kind_of_text(text: str, path: Path, how: How) -> _Kind:
    if text.startswith(HEADING):
        raise LinkFileError(f"{path} is a link.csv already: give it to `laglab link fit`")
    numbers = numbers_of(text)
    if numbers and is_trace(numbers):
        return _Kind("a mahimahi trace", lambda: read_mahimahi(numbers, how, str(path)), "--back")
    if is_ping(text):
        return _Kind("ping's output", lambda: read_ping(text, how, str(path)))
    raise LinkFileError(
        f"{path}: none of what is known here: ping's output, irtt's JSON, a mahimahi trace, a "
        "table of netem's, a telemetry log, a capture"
    )
