"""What a station heard and said, tick by tick, from the log of a run."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from laglab_protocol import (
    ROBOT,
    STATION,
    Applied,
    Assembly,
    Command,
    Estimate,
    Frame,
    Measurement,
    Plan,
    Planned,
    Restart,
    Tick,
    read_tlog,
)


class SessionTick(NamedTuple):
    """One tick of a session."""

    tick: int
    measurements: tuple[Measurement, ...]
    """All that arrived at this tick, however late, in the order in which they came."""
    command: Command | None
    """As sent at this tick; None when nothing was, and the robot held what it had."""
    estimate: Estimate | None = None
    """As told at this tick."""
    recalled: tuple[Applied, ...] = ()
    """What the robot recalled at this tick."""
    following: tuple[tuple[float, float], ...] = ()
    """What is planned to follow the command [m/s, rad/s]."""


def read_session(path: Path) -> Iterator[SessionTick]:
    """The session in a telemetry log (`robot.tlog`), of a simulated or a real robot.

    Raises TlogError when the file is none.
    """
    return heard(frame for _, frame in read_tlog(path))


def heard(frames: Iterable[Frame]) -> Iterator[SessionTick]:
    """The ticks in the frames of both directions; passed over are repeats, what is not whole,
    and what others than the robot and its station said. They go up, but where a robot has begun
    again."""
    arriving: list[Measurement] = []
    recalled: list[Applied] = []
    last: SessionTick | None = None
    plans, restart = Assembly(), Restart()
    for frame in frames:
        match (frame.system, frame.component), frame.message:
            case speaker, Measurement() as measurement if speaker == ROBOT:
                arriving.append(measurement)
            case speaker, Applied() as told if speaker == ROBOT:
                recalled.append(told)
            case speaker, Tick(tick, count) if speaker == ROBOT:
                if len(arriving) + len(recalled) == count and _is_next(tick, last, restart):
                    if last is not None:
                        yield last
                    last = SessionTick(tick, tuple(arriving), None, recalled=tuple(recalled))
                arriving, recalled = [], []
            case speaker, Command() | Estimate() as said if speaker == STATION and last:
                last = _with(last, said)
                if isinstance(said, Command) and said.plan:
                    last = _planned(last, plans.take(said))
            case speaker, Plan() as part if speaker == STATION and last:
                last = _planned(last, plans.take(part))
    if last is not None:
        yield last


def _is_next(tick: int, last: SessionTick | None, restart: Restart) -> bool:
    """As the station decides."""
    return last is None or restart.shows(tick, last.tick) or tick > last.tick


def _planned(last: SessionTick, whole: Planned | None) -> SessionTick:
    if whole is None or whole.tick != last.tick:
        return last
    return last._replace(following=whole.following)


def _with(last: SessionTick, said: Command | Estimate) -> SessionTick:
    if said.tick != last.tick:
        return last
    if isinstance(said, Command):
        return last._replace(command=said)
    return last._replace(estimate=said)
