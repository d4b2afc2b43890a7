"""Gateway and controller in two network namespaces: two hosts with a cable between them."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from statistics import median

import pytest

from .namespaces import Socket, emulate, inside, joined, machines

Answers = Callable[[], list[float]]
Cable = tuple[Socket, Socket]


@pytest.fixture
def cable() -> Iterator[Cable]:
    """The robot's machine and the station's."""
    with machines("robot", "station") as (robot, station):
        yield joined(robot, station, "10.213.77", "rs")


@pytest.fixture
def answers(cable: Cable, tmp_path: Path) -> Iterator[Answers]:
    """A real-time run across the cable: after what time each tick was answered [s]."""
    options = ("lab", "--pace", "realtime", "--speed", "0.1", "--duration", "0.25")
    robot = cable[0].address
    sides = (
        ("gateway", f"udpin://{robot}:14550", "--unsigned", "--out", "run"),
        ("controller", f"udpout://{robot}:14550"),
    )
    with ExitStack() as stack:

        def call() -> list[float]:
            started = []
            for end, (side, url, *more) in zip(cable, sides, strict=True):
                laglab = (sys.executable, "-m", "laglab", side, *options, "--endpoint", url, *more)
                process = subprocess.Popen(
                    inside(end.machine, *laglab), cwd=tmp_path, stderr=subprocess.PIPE, text=True
                )
                stack.callback(process.communicate)
                stack.callback(process.kill)
                started.append(process)
            for process in started:
                _, errors = process.communicate(timeout=40)
                assert process.returncode == 0, errors
            rows = (tmp_path / "run" / "timing.csv").read_text().splitlines()[1:]
            assert len(rows) == 26
            return [float(cells[2]) for cells in (row.split(",") for row in rows) if cells[2]]

        yield call


def test_two_hosts_find_each_other(answers: Answers) -> None:
    measured = answers()
    assert len(measured) >= 13
    assert 0.0 < median(measured) < 0.02


def test_the_measured_delay_is_what_netem_was_told(cable: Cable, answers: Answers) -> None:
    told = (0.015, 0.025)
    for end, delay in zip(cable, told, strict=True):
        emulate(end, "delay", f"{1e3 * delay:g}ms")
    measured = answers()
    assert len(measured) >= 13
    assert sum(told) < median(measured) < sum(told) + 0.015
