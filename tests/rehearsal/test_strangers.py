"""What strangers send ends no run and delays none: real processes, real UDP."""

import itertools
import json
import os
import re
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from laglab import open_run
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    CommandLong,
    End,
    EndReason,
    FileTransferProtocol,
    Heartbeat,
    MissionRequestList,
    ParamRequestList,
    ParamSet,
    ParamValue,
    Ping,
    Sender,
    Tick,
    frames_in,
    open_endpoint,
)
from laglab_protocol.signing.signature import Signer

Process = subprocess.Popen[str]
Start = Callable[..., Process]
FLOOD = 1.5
"""[s]"""
LOCAL = "udpin://127.0.0.1:0"
REAL_TIME = ("lab", "--pace", "realtime", "--duration", "3")


ANOTHER_KEY = bytes(32)
HEARTBEAT = Heartbeat(0, 6, 8, 0, 4, 3)


def datagrams() -> list[bytes]:
    """Garbage, frames of somebody else's, signatures of another key, requests, an end."""
    stranger = Sender(7, 7)
    signed = Sender(200, 190, Signer(ANOTHER_KEY, (0, 200, 190)))
    return [
        b"\xfd" * 1400,
        b"".join(stranger.frame(HEARTBEAT) for _ in range(60)),
        b"".join(signed.frame(HEARTBEAT) for _ in range(40)),
        stranger.frame(ParamRequestList(1, 1)) * 60 + stranger.frame(Ping(1, 1, 0, 0)) * 10,
        stranger.frame(MissionRequestList(1, 1)) * 40
        + stranger.frame(FileTransferProtocol(0, 1, 1, (0,) * 251)) * 10,
        b"\xfd",
    ]


def flood(seconds: float, rate: float, ports: list[int]) -> int:
    """Datagrams sent, at most `rate` a second: these tests share the machine with others."""
    said = list(itertools.product(datagrams(), ports))
    sent, started = 0, time.monotonic()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ours:
        while (elapsed := time.monotonic() - started) < seconds:
            if sent > rate * elapsed:
                time.sleep(0.001)
                continue
            for data, port in said:
                ours.sendto(data, ("127.0.0.1", port))
            sent += len(said)
    return sent


class Run:
    """A gateway with a link to watch it on, and its controller."""

    def __init__(self, start: Start, folder: Path, *options: str) -> None:
        watch = ("--endpoint", LOCAL, "--watch", LOCAL, "--out", folder / "robot")
        self.gateway = start("gateway", *options, *watch)
        self.folder = folder
        assert self.gateway.stderr is not None
        lines = [self.gateway.stderr.readline() for _ in range(2)]
        self.ports = [int(re.findall(r"udpin://127\.0\.0\.1:(\d+)", line)[0]) for line in lines]
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

    def work(self) -> float:
        """Processor time that the gateway has had [s]: unlike its lateness, all its own doing."""
        fields = Path(f"/proc/{self.gateway.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def said(self, side: Process, code: int) -> str:
        """All of it, once the side has ended as it should."""
        said = "".join(side.communicate(timeout=30))
        assert side.returncode == code, said
        assert "Traceback" not in said
        return said

    def ended(self) -> None:
        """Both in order."""
        for side in (self.gateway, self.controller):
            self.said(side, 0)

    @property
    def summary(self) -> dict[str, dict[str, Any]]:
        read: dict[str, dict[str, Any]] = json.loads(
            (self.folder / "robot" / "summary.json").read_text()
        )
        return read


@contextmanager
def speaking(port: int) -> Iterator[Callable[..., bytes]]:
    """Say something to the port, and hear the answer."""
    with open_endpoint(f"udpout://127.0.0.1:{port}") as endpoint:

        def say(data: bytes) -> bytes:
            endpoint.send(data)
            return endpoint.receive(2.0)

        yield say


@pytest.mark.slow
@pytest.mark.parametrize("signed", [False, True])
def test_a_flood_on_both_ports_changes_nothing(start: Start, tmp_path: Path, signed: bool) -> None:
    """Of everything; at a pace that leaves the machine to others, for these tests share it."""
    key = tmp_path / "key"
    if signed:
        start("protocol", "keygen", key).communicate(timeout=20)
    patient = ("--set", "safety.link_timeout=3")
    run = Run(start, tmp_path, *REAL_TIME, *patient, *(("--key", str(key)) if signed else ()))
    memory, work = run.memory(), run.work()
    assert flood(FLOOD, 3000, run.ports) > 3000
    assert run.work() - work < FLOOD / 2, "before, all that there was"
    assert run.memory() - memory < 4e6
    run.ended()
    assert run.summary["link"]["stops"] == 0


def test_neither_requests_nor_the_stations_name_end_a_run(start: Start, tmp_path: Path) -> None:
    """A datagram of requests is answered with a few short ones, on the loop's own link too; who
    pretends to be the station is told that there is one, as long as that one is in force: 3 s."""
    run = Run(start, tmp_path, *REAL_TIME, "--silence", "9")
    with speaking(run.ports[0]) as say:
        answer = say(Sender(255, 190).frame(ParamRequestList(1, 1)) * 148)
        assert len(answer) <= 1200
        assert any(isinstance(each.message, ParamValue) for each in frames_in(answer))
    stranger = Sender(STATION_SYSTEM, STATION_COMPONENT)
    with speaking(run.ports[0]) as say:
        (told,) = frames_in(say(stranger.frame(HEARTBEAT)))
        assert isinstance(told.message, End)
        assert told.message.reason == EndReason.DISPLACED
    run.ended()


STOP = CommandLong(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 185, 1, 1, 0)
SLOWER = ParamSet(0.05, 1, 1, b"V_MAX", 9)


def test_what_stops_the_robot_is_named_on_both_consoles(start: Start, tmp_path: Path) -> None:
    """A limit set below the commands; then an emergency stop, which the exit code tells, too."""
    run = Run(start, tmp_path, *REAL_TIME)
    with speaking(run.ports[1]) as say:
        say(Sender(255, 190).frame(SLOWER))
        time.sleep(1.0)
        say(Sender(255, 190).frame(STOP))
    limits = "commands are beyond V_MAX, OMEGA_MAX: stopping"
    stopped = "emergency stop: the robot stands still"
    robot, station = run.said(run.gateway, 5), run.said(run.controller, 5)
    for text in (limits, stopped):
        assert f"warning: {text}" in robot
        assert f"warning: the robot says: {text}" in station
    assert "no fresh command" not in station
    assert run.summary["link"]["refused"]["out of limits"] > 0
    assert run.summary["link"]["emergency_stops"] == 1
    (at,) = open_run(tmp_path / "robot").emergencies
    (heard,) = open_run(tmp_path / "station").emergencies
    assert at <= heard < at + 20


def test_a_robot_that_fails_is_the_controllers_failure_too(start: Start, tmp_path: Path) -> None:
    with open_endpoint("udpin://127.0.0.1:0") as robot:
        there = robot.name.replace("udpin", "udpout")
        controller = start("controller", "fig6", "--endpoint", there, "--out", tmp_path / "run")
        assert robot.receive(20.0)
        robot.accept_peer()
        ours = Sender(1, 1)
        robot.send(ours.frame(Tick(0, 0)))
        while not any(isinstance(each.message, Command) for each in frames_in(robot.receive(5.0))):
            pass
        robot.send(ours.frame(End(0, EndReason.FAILED)))
        said, _ = controller.communicate(timeout=20)
    assert controller.returncode == 4
    assert "stopped at tick 0: the other side failed" in said
