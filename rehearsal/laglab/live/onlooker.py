"""A station alone, and those who watch it."""

from collections.abc import Sequence

from laglab.live.feed import Controls, Feed
from laglab.live.messages import Line
from laglab_protocol import Endpoint
from laglab_station import Onlooker, Station


class _Watched(Onlooker):
    """Passes all on, and tells the live page."""

    def __init__(self, onlooker: Onlooker, feed: Feed) -> None:
        self._onlooker = onlooker
        self._feed = feed
        self.warned = onlooker.warned  # type: ignore[method-assign]

    def said(self, frames: Sequence[bytes], tick: int | None) -> None:
        self._onlooker.said(frames, tick)
        self._feed.said(frames)

    def answered(self, tick: int) -> None:
        self._onlooker.answered(tick)
        self._feed.flush()

    def close(self) -> None:
        self._feed.close()
        self._onlooker.close()


def watched_station(
    onlooker: Onlooker, line: str | None, station: Station, link: Endpoint
) -> Onlooker:
    """The onlooker, and a live page if there is one. The robot is stopped as a ground station
    does it: by a command over the link, said again until the robot says that it is so."""
    if line is None:
        return onlooker
    controls = Controls(
        stop=lambda: link.send(b"".join(station.stop_robot())),
        stopped=lambda: station.robot_stopped,
    )
    return _Watched(onlooker, Feed(Line.read(line), controls))
