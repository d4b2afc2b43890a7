"""What strangers send ends no run and delays none: real processes, real UDP."""

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from laglab_protocol import (
    STATION_COMPONENT,
    STATION_SYSTEM,
    End,
    EndReason,
    Heartbeat,
    ParamRequestList,
    ParamValue,
    Sender,
    frames_in,
    open_endpoint,
)

Process = subprocess.Popen[str]
Start = Callable[..., Process]
FLOOD = Path(__file__).parent / "flood.py"
LOCAL = "udpin://127.0.0.1:0"
REAL_TIME = ("lab", "--pace", "realtime", "--duration", "3")


class Run:
    """A gateway with a link to watch it on, and its controller."""

    def __init__(self, start: Start, folder: Path, *options: str) -> None:
        watch = ("--endpoint", LOCAL, "--watch", LOCAL, "--out", folder / "robot")
        self.gateway = start("gateway", *options, *watch)
        self.folder = folder
        assert self.gateway.stderr is not None
        lines = [self.gateway.stderr.readline() for _ in range(2)]
        self.ports = [line.strip().rpartition(":")[2] for line in lines]
        there = ("--endpoint", f"udpout://127.0.0.1:{self.ports[0]}", "--out", folder / "station")
        self.controller = start("controller", *options, *there)
        self.wait_until_under_way()

    def wait_until_under_way(self) -> None:
        trace = self.folder / "robot" / "trace.csv"
        deadline = time.monotonic() + 20
        while not (trace.exists() and trace.read_bytes().count(b"\n") > 20):
            assert time.monotonic() < deadline
            time.sleep(0.02)

    def memory(self) -> int:
        """Of the gateway [bytes]."""
        status = Path(f"/proc/{self.gateway.pid}/status").read_text()
        found = re.search(r"VmRSS:\s+(\d+)", status)
        assert found
        return 1024 * int(found[1])

    def ended(self, *codes: int) -> str:
        """All that the two said."""
        sides = (self.gateway, self.controller)
        said = ["".join(side.communicate(timeout=30)) for side in sides]
        assert tuple(side.returncode for side in sides) == (codes or (0, 0)), said
        assert "Traceback" not in said[0] + said[1]
        return said[0] + said[1]

    @property
    def summary(self) -> dict[str, dict[str, float]]:
        read: dict[str, dict[str, float]] = json.loads(
            (self.folder / "robot" / "summary.json").read_text()
        )
        return read


@contextmanager
def speaking(port: str) -> Iterator[Callable[..., bytes]]:
    """Say something to the port, and hear the answer."""
    with open_endpoint(f"udpout://127.0.0.1:{port}") as endpoint:

        def say(data: bytes) -> bytes:
            endpoint.send(data)
            return endpoint.receive(2.0)

        yield say


@pytest.mark.parametrize("signed", [False, True])
def test_a_flood_on_both_ports_changes_nothing(start: Start, tmp_path: Path, signed: bool) -> None:
    """As fast as a process can send, of everything; before, both sides ended with code 4."""
    key = tmp_path / "key"
    if signed:
        start("protocol", "keygen", key).communicate(timeout=20)
    run = Run(start, tmp_path, *REAL_TIME, *(("--key", str(key)) if signed else ()))
    before = run.memory()
    flood = (sys.executable, str(FLOOD), "1.5", "all", *run.ports)
    sent = int(subprocess.check_output(flood, timeout=20))
    assert sent > 10_000
    assert run.memory() - before < 4e6
    run.ended()
    assert run.summary["link"]["stops"] == 0
    assert run.summary["timing"]["missed_deadlines"] <= 15, "of 300; before, of nearly all"


def test_neither_requests_nor_the_stations_name_end_a_run(start: Start, tmp_path: Path) -> None:
    """A datagram of requests is answered with a few short ones, on the loop's own link too; who
    pretends to be the station is told that there is one."""
    run = Run(start, tmp_path, *REAL_TIME)
    with speaking(run.ports[0]) as say:
        answer = say(Sender(255, 190).frame(ParamRequestList(1, 1)) * 148)
        assert len(answer) <= 1200
        assert any(isinstance(each.message, ParamValue) for each in frames_in(answer))
    stranger = Sender(STATION_SYSTEM, STATION_COMPONENT)
    with speaking(run.ports[0]) as say:
        (told,) = frames_in(say(stranger.frame(Heartbeat(0, 6, 8, 0, 4, 3))))
        assert isinstance(told.message, End)
        assert told.message.reason == EndReason.DISPLACED
    run.ended()
