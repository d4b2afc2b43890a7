"""Who speaks as one of the loop's two sides does, under another name, and is heard by nobody."""

from collections.abc import Iterable

from laglab_protocol.framing.frame import Frame
from laglab_protocol.messages.loop import ROBOT, STATION, Command, Settings, Tick


def stranger_as_robot(frames: Iterable[Frame], where: str) -> str:
    """Whoever of these ticks, and what it should be, in a line; empty when nobody does."""
    ticks = (frame for frame in frames if isinstance(frame.message, Tick))
    return _named(ticks, where, "ticks", "robot", ROBOT)


def stranger_as_station(frames: Iterable[Frame], where: str) -> str:
    """Whoever of these commands or tells its settings, in a line; empty when nobody does."""
    said = (frame for frame in frames if isinstance(frame.message, Command | Settings))
    return _named(said, where, "speaks as a station", "station", STATION)


def _named(frames: Iterable[Frame], where: str, does: str, side: str, name: tuple[int, int]) -> str:
    for frame in frames:
        if (frame.system, frame.component) != name:
            return (
                f"{where}: system {frame.system}, component {frame.component} {does} there: a "
                f"{side} must be system {name[0]}, component {name[1]}"
            )
    return ""
