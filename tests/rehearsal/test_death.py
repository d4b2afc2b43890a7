"""A dead side, an estimate gone wild: the run survives or says why, and its files are whole."""

import json
import os
import random
import re
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from laglab.runs.rehearse import rehearse_apart
from laglab.scenario import load
from laglab_gateway import read_trace
from laglab_protocol import EndReason, read_tlog

from .traces import assert_whole, wait_for_rows

Start = Callable[..., "subprocess.Popen[str]"]
ListeningPort = Callable[["subprocess.Popen[str]"], str]
NOTICED_WITHIN = 10.0


def said_in_time(process: "subprocess.Popen[str]", words: str) -> str:
    """What it says on standard error to its end, once it has said that in time."""
    began, said = time.monotonic(), ""
    assert process.stderr is not None
    while not re.search(words, said):
        line = process.stderr.readline()
        assert line, said
        said += line
    assert time.monotonic() - began < NOTICED_WITHIN
    return said + process.communicate(timeout=20)[1]


@pytest.mark.parametrize(
    ("victim", "said"),
    [
        ("controller", r"laglab: the controller has been silent since tick \d+"),
        ("gateway", r"laglab: .*silent .*since its tick \d+"),
    ],
    ids=["controller", "gateway"],
)
def test_the_other_side_notices_a_dead_one(
    start: Start, listening_port: ListeningPort, tmp_path: Path, victim: str, said: str
) -> None:
    options = ("fig6", "--duration", "3600")
    gateway = start("gateway", *options, "--endpoint", "udpin://127.0.0.1:0", "--out", "run")
    station = start(
        "controller", *options, "--endpoint", f"udpout://127.0.0.1:{listening_port(gateway)}"
    )
    wait_for_rows(tmp_path / "run" / "trace.csv", 50)
    dies, stays = (station, gateway) if victim == "controller" else (gateway, station)
    dies.kill()
    errors = said_in_time(stays, said)
    assert stays.returncode == 4
    assert "Traceback" not in errors
    assert_whole(tmp_path / "run" / "trace.csv")


SIDES = {"gateway": b"robot_side", "controller": b"station_side"}


def children() -> dict[int, bytes]:
    """The sides that this process has started and that still run, and their command lines."""
    path = Path(f"/proc/self/task/{threading.main_thread().native_id}/children")
    commands = {number: command_line(number) for number in map(int, path.read_text().split())}
    sides = SIDES.values()
    return {
        number: command
        for number, command in commands.items()
        if any(side in command for side in sides)
    }


@pytest.fixture(autouse=True)
def temporaries(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[None]:
    """What a side had unpacked when it was killed is cleared by who started it."""
    folder = tmp_path_factory.mktemp("tmp")
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    monkeypatch.setenv("TMPDIR", str(folder))  # for children that are not told of another
    yield
    assert list(folder.iterdir()) == []


def command_line(number: int) -> bytes:
    """Nothing, if it has ended meanwhile."""
    try:
        return Path(f"/proc/{number}/cmdline").read_bytes()
    except (FileNotFoundError, ProcessLookupError):
        return b""


def kill_children(side: str) -> None:
    for number, command in children().items():
        if SIDES[side] in command:
            with suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)


@pytest.mark.parametrize("victim", ["gateway", "controller"])
@pytest.mark.parametrize("transport", ["udp", "serial"])
def test_a_run_whose_side_is_killed_says_which(victim: str, transport: Any, tmp_path: Path) -> None:
    def kill(tick: int, _: object) -> None:
        if tick > 20:
            kill_children(victim)

    scenario = load("fig6", {"duration": 3600.0})
    started = time.monotonic()
    ending = rehearse_apart(scenario, transport, tmp_path, kill)
    assert time.monotonic() - started < 10 + NOTICED_WITHIN
    assert ending.outcome is None
    assert f"the {victim} process was killed by SIGKILL" in str(ending.problem)
    if victim == "controller":
        assert "has been silent since tick" in str(ending.problem)
        assert ending.link is not None
    assert not children()
    assert_whole(tmp_path / "trace.csv")


@pytest.mark.slow
@pytest.mark.timeout(120)
@pytest.mark.parametrize("victims", [("gateway",), ("controller",), ("gateway", "controller")])
def test_files_are_whole_whenever_a_side_is_killed(
    victims: tuple[str, ...], tmp_path: Path
) -> None:
    """At random moments of lock-step, where thousands of ticks pass in a second."""
    rng = random.Random(str(victims))
    for attempt in range(2):
        moment = rng.uniform(0.0, 0.6)

        def kill(moment: float = moment) -> None:
            time.sleep(moment)
            for victim in victims:
                kill_children(victim)

        killer = threading.Thread(target=kill)

        def started(_: int, __: object, killer: threading.Thread = killer) -> None:
            if killer.ident is None:
                killer.start()

        scenario = load("lab-radio", {"duration": 3600.0, "silence_timeout": 2.5})
        directory = tmp_path / str(attempt)
        ending = rehearse_apart(scenario, "udp", directory, started)
        killer.join()
        assert "was killed by SIGKILL" in str(ending.problem)
        assert_whole(directory / "trace.csv")
        link = (directory / "link.csv").read_text()
        assert link.endswith("\n")
        assert len({line.count(",") for line in link.splitlines()}) == 1
        size = (directory / "robot.tlog").stat().st_size
        assert sum(8 + len(frame.raw) for _, frame in read_tlog(directory / "robot.tlog")) == size


@pytest.mark.slow
@pytest.mark.parametrize("pace", [("lockstep",), ("realtime", "--speed", "2")])
def test_a_controller_started_again_takes_over(
    start: Start, listening_port: ListeningPort, tmp_path: Path, pace: tuple[str, ...]
) -> None:
    options = ("lab", "--pace", *pace, "--silence", "20")
    gateway = start("gateway", *options, "--endpoint", "udpin://127.0.0.1:0", "--out", "run")
    link = ("--endpoint", f"udpout://127.0.0.1:{listening_port(gateway)}")
    first = start("controller", *options, *link)
    wait_for_rows(tmp_path / "run" / "trace.csv", 150)
    first.kill()
    second = start("controller", *options, *link)
    assert gateway.wait(40) == 0
    assert second.wait(10) == 0
    trace = read_trace(tmp_path / "run" / "trace.csv")
    assert trace["tick"][-1] == 2000
    assert np.isnan(trace["x_est"][150:1500]).sum() >= 100  # stood still, and looked
    assert np.hypot(trace["x"][-100:], trace["y"][-100:]).max() < 0.06
    assert np.abs(trace["theta"][-100:]).max() < 0.05


@pytest.mark.parametrize("transport", ["inline", "udp", "serial"])
def test_an_estimate_beyond_a_kilometre_stops_the_robot(
    ended: Callable[..., Any], tmp_path: Path, transport: str
) -> None:
    options = ("--transport", transport, "--out", tmp_path / "run")
    code, out, _ = ended("run", "fig8", "--p0", "0.1", "--duration", "60", *options)
    assert code == 3
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    trace = read_trace(tmp_path / "run" / "trace.csv")
    last = int(trace["tick"][-1])
    assert f"stopped at tick {last}" in summary["verdict"]
    assert summary["verdict"] in out
    assert trace["v_sent"][-1] == trace["omega_sent"][-1] == 0
    assert not abs(trace["x_est"][-1]) < 1000 or not abs(trace["y_est"][-1]) < 1000
    assert (tmp_path / "run" / "figure.png").exists()


def test_a_run_is_complete_only_at_its_last_tick(tmp_path: Path) -> None:
    ending = rehearse_apart(load("fig6", {"duration": 0.3}), "udp", tmp_path)
    assert ending.outcome is not None
    assert ending.outcome == (EndReason.COMPLETED, 30)
