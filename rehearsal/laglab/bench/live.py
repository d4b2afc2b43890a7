"""What a live page costs the loop: how late ticks on the wall clock begin, with and without it."""

import selectors
import socket
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from threading import Thread
from urllib.parse import urlsplit

from laglab.bench.harness import MILLISECONDS, Bench, Contest, Progress, Turn
from laglab.bench.result import Figure, Result
from laglab.bench.whole_run import lateness, realtime_scenario
from laglab.live import Place, live_page
from laglab.live.place import LOOPBACK

NO_PAGE = "no page"
CROWD = 100


def bench(seconds: float) -> Bench:
    """Runs of `seconds` over UDP; a turn gives the 99th percentile of its ticks' lateness."""
    ways: dict[str, Turn] = {
        NO_PAGE: lambda: _late(seconds),
        "a page": lambda: _late_with_page(seconds, 0, 0),
        f"{CROWD} readers": lambda: _late_with_page(seconds, CROWD, 0),
        f"{CROWD} that stall": lambda: _late_with_page(seconds, 0, CROWD),
    }
    contest = Contest("ticks late by, p99", MILLISECONDS, NO_PAGE, {"real time, 100 Hz": ways})
    return Bench("live", [contest], _in_the_median)


def _in_the_median(results: Sequence[Result], _: Progress) -> list[Figure]:
    """The 99th percentile rests on five ticks in five hundred, where chance decides: the fastest
    turn is not to be relied on."""
    without, *others = results[0].timings
    return [
        Figure(f"{each.name} to {without.name}, in the median", each.median / without.median, "×")
        for each in others
    ]


def _late(seconds: float, line: str | None = None) -> float:
    with tempfile.TemporaryDirectory(prefix="laglab-bench-") as folder:
        return lateness(seconds, Path(folder), line).p99_s


def _late_with_page(seconds: float, readers: int, stalled: int) -> float:
    scenario = realtime_scenario(seconds)
    with live_page(scenario, Place(LOOPBACK, 0), "a benchmark") as page, ExitStack() as stack:
        for _ in range(stalled):
            stack.enter_context(_reader(page.address))
        stack.enter_context(
            _read([stack.enter_context(_reader(page.address)) for _ in range(readers)])
        )
        return _late(seconds, page.line)


def _reader(address: str) -> socket.socket:
    """A reader that has asked for all that comes."""
    url = urlsplit(address)
    reader = socket.create_connection((LOOPBACK, url.port or 0))
    reader.sendall(f"GET /events?{url.query} HTTP/1.1\r\nHost: {url.netloc}\r\n\r\n".encode())
    return reader


@contextmanager
def _read(readers: list[socket.socket]) -> Iterator[None]:
    """All that comes to them, for as long as the context lasts."""
    ours, theirs = socket.socketpair()
    with selectors.DefaultSelector() as selector, ours, theirs:
        for each in (*readers, theirs):
            selector.register(each, selectors.EVENT_READ)
        thread = Thread(target=_read_on, args=(selector, theirs))
        thread.start()
        try:
            yield
        finally:
            ours.send(b"!")
            thread.join()


def _read_on(selector: selectors.BaseSelector, until: socket.socket) -> None:
    while True:
        for key, _ in selector.select():
            if key.fileobj is until:
                return
            assert isinstance(key.fileobj, socket.socket)
            if not key.fileobj.recv(1 << 16):
                selector.unregister(key.fileobj)
