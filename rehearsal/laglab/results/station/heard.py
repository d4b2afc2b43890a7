"""What the frames of a session tell of the link and of the station's claims."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from laglab_gateway import ArrivalRow, ClaimRow, claimed
from laglab_protocol import Frame, decode
from laglab_station import SessionTick


def decoded(frames: Iterable[bytes]) -> Iterator[Frame]:
    """Those that are whole."""
    for raw in frames:
        if isinstance(frame := decode(raw, 0), Frame):
            yield frame


class HeardTick(NamedTuple):
    """One tick of a session, and what a run's tables say of it."""

    tick: SessionTick
    arrivals: list[ArrivalRow]
    claims: list[ClaimRow]


def heard_ticks(
    session: Iterable[SessionTick], sample_time: float, first: int | None = None
) -> Iterator[HeardTick]:
    """Each tick with the measurements that came with it; with the commands that the robot says, for
    the first time, were in force; and with what the station claimed.

    `first` is the run's first tick; the session's first, if it is not given.
    """
    in_force, last, before = -1, -1, None
    for heard in session:
        if before is not None and heard.tick < before:
            in_force = last = -1
        first, before = origin(first, before, heard.tick), heard.tick
        arrivals: list[ArrivalRow] = []
        for z in heard.measurements:
            arrivals.append(_arrival("measurement", z.tick, heard.tick, first, sample_time))
            if z.command_tick > in_force:
                in_force = z.command_tick
                if z.tick == last + 1 and z.tick > first:  # else it may be in force for longer
                    arrivals.append(_arrival("command", in_force, z.tick - 1, first, sample_time))
            last = z.tick
        time = (heard.tick - first) * sample_time
        claim = claimed(heard.estimate, time) if heard.estimate else None
        yield HeardTick(heard, arrivals, [claim] if claim else [])


def origin(first: int | None, last: int | None, tick: int) -> int:
    """The tick at which a run's time is 0, now that one more is heard: where the robot's ticks have
    begun again, the time goes on."""
    if first is None:
        return tick
    return tick - (last - first + 1) if last is not None and tick < last else first


def _arrival(direction: str, stamp: int, tick: int, first: int, sample_time: float) -> ArrivalRow:
    return ArrivalRow(direction, stamp, tick, (tick - first) * sample_time)
