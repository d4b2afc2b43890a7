"""A link between two machines, measured, fitted, rehearsed and driven over: docs/link.md."""

import json
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from laglab.link.measured import read_measured
from laglab.scenario import load

from ..namespaces import Socket, emulate, inside, joined, machines

PAGE = (Path(__file__).parents[3] / "docs" / "link.md").read_text(encoding="utf-8")
CASE = re.findall(r"```sh\n# (.*?)\n(.*?)```", PAGE, flags=re.DOTALL)
ROBOT, STATION = "on the robot's machine", "on the station's machine"
UP, DOWN, JITTER, LOSS = 0.030, 0.020, 0.003, 0.01
PORT = "14550"
Start = Callable[..., "subprocess.Popen[str]"]


def arguments(command: str) -> tuple[str, ...]:
    return (sys.executable, "-m", *shlex.split(command))


@pytest.fixture
def elsewhere(start_program: Start) -> Iterator[tuple[str, str]]:
    """The robot's machine and the station's, a relay of ours on the one between them."""
    with machines("robot", "between", "station") as (robot, between, station):
        far, near = joined(robot, between, "10.213.78", "ab")
        here, _ = joined(between, station, "10.213.77", "cd")
        link = map(str, (UP, DOWN, JITTER, LOSS))
        program = str(Path(__file__).parents[1] / "relay.py")
        start_program(
            *inside(between, sys.executable, program, here.address, PORT, far.address, *link)
        )
        assert near.machine == here.machine
        yield robot, station


@pytest.mark.slow
@pytest.mark.timeout(240)
def test_the_real_case_goes_as_the_page_says(
    elsewhere: tuple[str, str], start_program: Start, tmp_path: Path
) -> None:
    robot, station = elsewhere
    (_, keygen), (_, echo), (_, measuring), (_, gateway), (_, driving), (_, afterwards) = CASE
    told(robot, keygen, tmp_path)
    echoing = start_program(*inside(robot, *arguments(echo)))
    assert echoing.stderr is not None
    assert "waiting for" in echoing.stderr.readline()
    said = told(station, measuring, tmp_path)
    echoing.send_signal(signal.SIGINT)
    assert echoing.wait(20) == 130
    assert "half of the shortest round trip" in said
    assert re.search(r"Without play-out: n = [34], m = [34],", said), said
    measured = read_measured(tmp_path / "link.csv", 0.01)
    shortest = sum(float(flow.delivered.min()) for _, flow in measured.flows)
    assert UP + DOWN - 0.0005 < shortest < UP + DOWN + 0.005
    for _, flow in measured.flows:
        assert len(flow.delay) == 500
        assert 0 < flow.lost.mean() < 4 * LOSS
    link = load(str(tmp_path / "link.toml")).link
    assert (link.command_delay, link.measurement_delay) == (2, 2), "half of 50 ms each"
    for run in ("rehearsed", "replayed"):
        assert json.loads((tmp_path / "runs" / run / "summary.json").read_text())["converged"]

    gate = start_program(*inside(robot, *arguments(gateway)))
    assert gate.stderr is not None
    assert "listening on" in gate.stderr.readline()
    told(station, driving, tmp_path)
    _, errors = gate.communicate(timeout=40)
    assert gate.returncode == 0, errors
    summary = json.loads((tmp_path / "runs" / "robot" / "summary.json").read_text())
    assert summary["converged"]
    told(robot, afterwards, tmp_path)
    again = read_measured(tmp_path / "afterwards.csv", 0.01)
    both = 2 * np.median(again.command.delivered)
    assert UP + DOWN - 0.01 <= both <= UP + DOWN + 0.04


def told(machine: str, commands: str, folder: Path) -> str:
    """What they say on that machine, one after the other; each ends well."""
    said = ""
    for command in commands.splitlines():
        done = subprocess.run(
            inside(machine, *arguments(command)),
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, f"{command}: {done.stderr}"
        said += " ".join(done.stdout.split()) + " "
    return said


def test_every_command_of_the_case_is_said_where_it_runs() -> None:
    assert [place for place, _ in CASE][1:] == [ROBOT, STATION, ROBOT, STATION, ROBOT]
    assert all(line.startswith("laglab ") for _, lines in CASE for line in lines.splitlines())


@pytest.fixture
def cable() -> Iterator[tuple[Socket, Socket]]:
    with machines("robot", "station") as (robot, station):
        yield joined(robot, station, "10.213.77", "rs")


def test_the_probe_measures_what_netem_was_told(
    cable: tuple[Socket, Socket], start_program: Start, tmp_path: Path
) -> None:
    delays, loss = (0.030, 0.020), 0.1
    for end, delay in zip(cable, delays, strict=True):
        emulate(end, "delay", f"{1e3 * delay:g}ms", "loss", f"{100 * loss:g}%")
    robot, station = cable
    echo = f"laglab link echo udpin://{robot.address}:{PORT} --unsigned"
    echoing = start_program(*inside(robot.machine, *arguments(echo)))
    assert echoing.stderr is not None
    assert "waiting for" in echoing.stderr.readline()
    probe = f"laglab link probe udpout://{robot.address}:{PORT} --duration 4 --clocks-within 0"
    told(station.machine, probe, tmp_path)
    measured = read_measured(tmp_path / "link.csv", 0.01)
    # What the robot's end was told holds back measurements.
    for (_, flow), delay in zip(measured.flows, reversed(delays), strict=True):
        assert delay - 0.001 < np.median(flow.delivered) < delay + 0.01
        assert 0.3 * loss < flow.lost.mean() < 2 * loss
