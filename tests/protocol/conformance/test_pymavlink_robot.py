"""The robot in examples/, which was written from the page, with pymavlink alone, conforms."""

import ast
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from laglab_conformance import Waits, conform
from laglab_protocol import open_endpoint

ROBOT = Path(__file__).parents[3] / "examples" / "pymavlink_robot.py"
MISSED = {
    "a false start before a frame costs nothing",
    "it tells its settings",
    "it recalls what was in force",
    "it goes on by the plan of a command",
    "it reports Heartbeat on request",
    "it reports AutopilotVersion on request",
    "it lists its parameters",
    "it reads a parameter by index and name",
    "it answers a ping",
}
"""What it does without, all optional: the first is its parser's fault."""


@pytest.mark.slow
def test_it_conforms(start_program: Callable[..., Any]) -> None:
    with open_endpoint("udpin://127.0.0.1:0") as free:
        url = free.name.replace("udpin", "udpout")
    start_program(sys.executable, ROBOT, url.rpartition(":")[2])
    report = conform(url, "robot", waits=Waits(appear=10.0, react=1.0, refuse=0.2))

    assert report.conforms, report.table()
    assert set(report.failed) == MISSED


MANY_TICKS = 200_000
"""Bytes of a log: some hundred ticks."""


@pytest.mark.slow
def test_a_station_that_plans_drives_it_though_it_passes_plans_over(
    start_program: Callable[..., Any], tmp_path: Path
) -> None:
    with open_endpoint("udpin://127.0.0.1:0") as free:
        url = free.name.replace("udpin", "udpout")
    start_program(sys.executable, ROBOT, url.rpartition(":")[2])
    station = "-m", "laglab", "controller", "lab", "--endpoint", url, "--out", "station"
    planning = ("--set", "link.plan=30", "-n", "0", "-m", "0", "--silence", "20")
    running = start_program(sys.executable, *station, *planning)
    log, deadline = tmp_path / "station" / "robot.tlog", time.monotonic() + 30
    while not log.exists() or log.stat().st_size < MANY_TICKS:
        assert running.poll() is None, running.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.1)


def test_it_knows_nothing_of_laglab_but_the_generated_file() -> None:
    names = [
        node.module
        for node in ast.walk(ast.parse(ROBOT.read_text()))
        if isinstance(node, ast.ImportFrom) and "laglab" in str(node.module)
    ]
    assert names == ["laglab_protocol.dialect.generated"]
