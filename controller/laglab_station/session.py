"""A recorded session, tick by tick, as the station lived through it."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from laglab_protocol import Command, Frame, Measurement, Tick, read_tlog


class Heard(NamedTuple):
    """One tick of a session."""

    tick: int
    measurements: tuple[Measurement, ...]
    """All that arrived at this tick, however late, in the order in which they came."""
    command: Command | None
    """As sent at this tick; None when nothing was, and the robot held what it had."""


def read_session(path: Path) -> Iterator[Heard]:
    """The session in a telemetry log (`robot.tlog`), of a simulated or a real robot.

    Raises TlogError when the file is none.
    """
    return heard(frame for _, frame in read_tlog(path))


def heard(frames: Iterable[Frame]) -> Iterator[Heard]:
    """The ticks in the frames of both directions; repeats and what is not whole are passed over."""
    arriving: list[Measurement] = []
    last: Heard | None = None
    for frame in frames:
        match frame.message:
            case Measurement():
                arriving.append(frame.message)
            case Tick(tick, count):
                if len(arriving) == count and (last is None or tick > last.tick):
                    if last is not None:
                        yield last
                    last = Heard(tick, tuple(arriving), None)
                arriving = []
            case Command(tick=tick) if last is not None and tick == last.tick:
                last = last._replace(command=frame.message)
    if last is not None:
        yield last
