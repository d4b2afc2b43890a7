"""A live page beside a run: its process is there for as long as the context lasts."""

import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Queue

from laglab.errors import LiveError
from laglab.live.messages import Caller, Line, LiveOrder, Over
from laglab.live.place import Place
from laglab.runs.processes.child import Inbox, started
from laglab.runs.processes.reports import Ended, Failed, Showing
from laglab.scenario import Scenario

SECRET_BYTES = 16


class LivePage:
    """What whoever runs the loop knows of its page."""

    def __init__(self, place: Place, token: str, line: str) -> None:
        self.line = line
        """By which the loop's feed calls the page, as text."""
        self.address = f"http://{_in_url(place.host)}:{place.port}/?token={token}"
        self._place = place

    @property
    def warning(self) -> str | None:
        """What must be said of a page that others can reach."""
        if self._place.local:
            return None
        return (
            f"the live page at {self._place.host}:{self._place.port} is open to the network: "
            "whoever has its address, token and all, can watch, stop the robot and end the run; "
            "nothing is encrypted"
        )

    def over(self, verdict: str) -> None:
        """Tell whoever looks how the run ended."""
        caller = Caller(Line.read(self.line))
        caller.say(Over(verdict))
        caller.close()


@contextmanager
def live_page(
    scenario: Scenario,
    place: Place,
    origin: str,
    station_alone: bool = False,
    measured: bool = False,
) -> Iterator[LivePage]:
    """A page, open to whoever has its address; gone at the end.

    Raises LiveError when it cannot be at that place.
    """
    token, secret = secrets.token_urlsafe(SECRET_BYTES), secrets.token_hex(SECRET_BYTES)
    order = LiveOrder(
        scenario.to_toml(), place.host, place.port, token, secret, station_alone, measured, origin
    )
    inbox: Inbox = Queue()
    with started("live page", "laglab.live.server:serve", order, inbox):
        port, line = _where(inbox)
        yield LivePage(Place(place.host, port), token, line)


def _where(inbox: Inbox) -> tuple[int, str]:
    while True:
        match inbox.get().report:
            case Showing(port, line):
                return port, line
            case Failed(reason):
                raise LiveError(reason)
            case Ended(how):
                raise LiveError(f"--live: {how}")


def _in_url(host: str) -> str:
    return f"[{host}]" if ":" in host else host
