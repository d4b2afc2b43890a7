"""The live page: what a browser shows of a run while it runs, and what it can do to it."""

import os
import re
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from http.client import HTTPConnection
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

import numpy as np
import pytest

from laglab import open_run

from .browser import Tab

pytestmark = [pytest.mark.slow, pytest.mark.timeout(180)]
Start = Callable[..., "subprocess.Popen[str]"]
REALTIME = ("run", "lab", "--pace", "realtime", "--out", "out", "--live")


class Live(NamedTuple):
    """A command that has a live page."""

    process: "subprocess.Popen[str]"
    address: str

    @property
    def port(self) -> int:
        return urlsplit(self.address).port or 0

    def ended(self) -> int:
        """Its exit code."""
        self.process.communicate(timeout=40)
        return self.process.returncode

    def asked(self, method: str, path: str, headers: dict[str, str] | None = None) -> int:
        """The status of the answer."""
        link = HTTPConnection("127.0.0.1", self.port, timeout=10)
        try:
            link.request(method, path, headers=headers or {})
            return link.getresponse().status
        finally:
            link.close()


def address_in(process: "subprocess.Popen[str]") -> str:
    assert process.stderr is not None
    for line in process.stderr:
        if found := re.search(r"live at (http://127\.0\.0\.1:\d+/\?token=\S+)", line):
            return found[1]
    raise AssertionError("it told no address")


@pytest.fixture
def live(start: Start) -> Callable[..., Live]:
    def begin(*arguments: str) -> Live:
        process = start(*arguments)
        return Live(process, address_in(process))

    return begin


def is_free(port: int) -> bool:
    with socket.socket() as ours:
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            ours.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def freed(port: int) -> bool:
    """Soon."""
    deadline = time.monotonic() + 10
    while not is_free(port) and time.monotonic() < deadline:
        time.sleep(0.05)
    return is_free(port)


def test_it_follows_the_run_and_stops_the_robot(
    live: Callable[..., Live], tab: Tab, tmp_path: Path
) -> None:
    run = live(*REALTIME, "--duration", "12")
    tab.open(run.address)
    tab.wait("source('ticks', 0).data.time.length > 50")
    causes = set(tab.column("marks-0", "what"))
    assert causes >= {"lost", "late"}, "the legend shows a mark of each, though none has come"
    assert tab.column("robot-0", "x")
    tab.click("#stop")
    tab.wait("document.getElementById('state').textContent.includes('the robot is stopped')")
    assert "emergency stop" in tab.text("#notices")
    assert tab.text("#news") == ""
    assert tab.value("document.getElementById('stop').disabled")
    assert run.ended() == 5
    tab.wait("over")
    done = open_run(tmp_path / "out")
    assert tab.text("#state") == done.summary.verdict
    assert "after an emergency stop" in done.summary.verdict
    ticks = np.array(tab.column("ticks-0", "tick"), dtype=int)
    assert len(ticks) > 1000
    for name in ("x", "x_est", "v_sent"):
        told = np.array(tab.column("ticks-0", name), dtype=float)
        assert np.allclose(told, done.trace[name][ticks], atol=1e-4, equal_nan=True)
    assert done.trace["v"][-1] == 0.0
    assert np.median(tab.column("commands-0", "delay")) >= 10
    assert tab.errors == []
    ours = ("data:", f"http://127.0.0.1:{run.port}/")
    assert [each for each in tab.requests if not each.startswith(ours)] == []
    assert freed(run.port)


@pytest.mark.slow
def test_without_a_clock_it_follows_the_run_too(live: Callable[..., Live], tab: Tab) -> None:
    run = live("run", "lab", "--duration", "36000", "--live")
    tab.open(run.address)
    tab.wait("document.getElementById('state').textContent.startsWith('running: ')")
    tab.wait("source('ticks', 0).data.time.length > 50")
    assert "ticks began late by" not in tab.text("body")
    tab.click("#end")
    assert run.ended() == 130
    tab.wait("over")
    assert tab.errors == []


def test_it_ends_the_run(live: Callable[..., Live], tab: Tab, tmp_path: Path) -> None:
    run = live(*REALTIME, "--duration", "60")
    tab.open(run.address, wide=400)
    tab.wait("source('ticks', 0).data.time.length > 20")
    tab.wait("document.documentElement.scrollWidth <= 400")
    tab.click("#end")
    assert run.ended() == 130
    tab.wait("over")
    assert tab.text("#state").startswith("interrupted at tick")
    assert open_run(tmp_path / "out").summary.outcome == "interrupted"


def test_without_the_token_one_may_look(live: Callable[..., Live], tab: Tab) -> None:
    run = live(*REALTIME, "--duration", "60")
    tab.open(f"http://127.0.0.1:{run.port}/")
    tab.wait("source('ticks', 0).data.time.length > 20")
    assert tab.value("document.querySelectorAll('.buttons button').length") == 0
    token, ours = urlsplit(run.address).query, f"http://127.0.0.1:{run.port}"
    for path in ("/stop", "/stop?token=", "/stop?token=guessed", "/end"):
        assert run.asked("POST", path, {"Origin": ours}) == 403
    for wrong in ({}, {"Origin": "null"}, {"Origin": "http://elsewhere.example"}):
        assert run.asked("POST", f"/stop?{token}", wrong) == 403
    assert run.asked("GET", f"/stop?{token}", {"Origin": ours}) == 405
    assert run.asked("GET", f"/?{token}", {"Host": f"elsewhere.example:{run.port}"}) == 403
    assert run.asked("GET", "/?token=guessed") == 403
    assert run.asked("GET", f"/trace.csv?{token}") == 404
    assert tab.value("source('ticks', 0).data.v.length") > 0  # nothing of this stopped it
    assert run.asked("POST", f"/end?{token}", {"Origin": ours}) == 202
    assert run.ended() == 130


def test_a_station_stops_its_robot_from_its_own_page(
    start: Start,
    live: Callable[..., Live],
    listening_port: Callable[["subprocess.Popen[str]"], str],
    tab: Tab,
) -> None:
    paced = ("lab", "--pace", "realtime", "--duration", "12")
    gateway = start("gateway", *paced, "--endpoint", "udpin://127.0.0.1:0")
    url = f"udpout://127.0.0.1:{listening_port(gateway)}"
    station = live("controller", *paced, "--endpoint", url, "--live")
    tab.open(station.address)
    tab.wait("source('ticks', 0).data.time.length > 50")
    estimated = np.isfinite(np.array(tab.column("ticks-0", "x_est"), dtype=float)[-20:])
    assert estimated.sum() > 1, "but for ticks that are passed over where others need the processor"
    tab.click("#stop")
    tab.wait("document.getElementById('state').textContent.includes('the robot is stopped')")
    gateway.communicate(timeout=40)
    assert (gateway.returncode, station.ended()) == (5, 5)
    assert tab.errors == []


def test_a_gateway_alone_is_ended_before_anybody_came(live: Callable[..., Live]) -> None:
    run = live("gateway", "lab", "--endpoint", "udpin://127.0.0.1:0", "--live")
    token, ours = urlsplit(run.address).query, f"http://127.0.0.1:{run.port}"
    time.sleep(0.5)  # it tells its page of itself now and then
    assert run.asked("POST", f"/end?{token}", {"Origin": ours}) == 202
    assert run.ended() == 130
    assert freed(run.port)


@pytest.fixture
def stalled() -> Iterator[Callable[[int, str], list[socket.socket]]]:
    """Readers that ask for all that comes, and never read."""
    opened: list[socket.socket] = []

    def open_(how_many: int, address: str) -> list[socket.socket]:
        url = urlsplit(address)
        for _ in range(how_many):
            reader = socket.create_connection(("127.0.0.1", url.port or 0))
            opened.append(reader)
            reader.sendall(
                f"GET /events?{url.query} HTTP/1.1\r\nHost: {url.netloc}\r\n\r\n".encode()
            )
        return opened

    yield open_
    for each in opened:
        each.close()


def test_a_hundred_readers_that_do_not_read_hold_nobody(
    live: Callable[..., Live], stalled: Callable[[int, str], list[socket.socket]], tmp_path: Path
) -> None:
    run = live(*REALTIME, "--duration", "3")
    stalled(100, run.address)
    assert run.asked("GET", "/") == 200, "whoever reads is answered meanwhile"
    assert run.ended() == 0
    assert open_run(tmp_path / "out").summary.ticks == 300
    assert freed(run.port)


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_nothing_is_left_behind(live: Callable[..., Live], how: signal.Signals) -> None:
    run = live(*REALTIME, "--duration", "60")
    time.sleep(0.5)
    os.kill(run.process.pid, how)
    run.ended()
    assert freed(run.port)


def test_a_port_that_is_taken_is_told_in_a_line(start: Start) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        process = start("run", "lab", "--live", str(port))
        _, told = process.communicate(timeout=40)
    assert process.returncode == 2
    assert told.startswith(f"laglab: --live: cannot listen at 127.0.0.1:{port}: ")
    assert len(told.splitlines()) == 1
