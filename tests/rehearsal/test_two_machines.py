"""Gateway and controller in two network namespaces: two hosts with a cable between them."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from statistics import median

import pytest

NAMES = (f"laglab-robot-{os.getpid()}", f"laglab-station-{os.getpid()}")
DEVICES = (f"lgr{os.getpid()}", f"lgs{os.getpid()}")
ADDRESSES = ("10.213.77.1", "10.213.77.2")
Answers = Callable[[], list[float]]


def run(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, capture_output=True, text=True, check=False)


def needed(*words: str) -> None:
    """Run it; a machine that does not let us is no machine for these tests."""
    if shutil.which(words[0]) is None:
        pytest.skip(f"no `{words[0]}` here: install iproute2")
    result = run(*words)
    if result.returncode:
        pytest.skip(f"`{' '.join(words)}`: {result.stderr.strip()}")


@pytest.fixture
def cable() -> Iterator[None]:
    """Two namespaces joined by a veth pair; gone afterwards, whatever happened."""
    with ExitStack() as stack:
        for name in NAMES:
            needed("ip", "netns", "add", name)
            stack.callback(run, "ip", "netns", "del", name)
        robot, station = DEVICES
        peer = ("peer", "name", station, "netns", NAMES[1])
        needed("ip", "link", "add", robot, "netns", NAMES[0], "type", "veth", *peer)
        for name, device, address in zip(NAMES, DEVICES, ADDRESSES, strict=True):
            needed("ip", "-n", name, "addr", "add", f"{address}/30", "dev", device)
            needed("ip", "-n", name, "link", "set", device, "up")
        yield


@pytest.fixture
def answers(cable: None, tmp_path: Path) -> Iterator[Answers]:
    """A real-time run across the cable: after what time each tick was answered [s]."""
    del cable
    options = ("lab", "--pace", "realtime", "--speed", "0.1", "--duration", "0.25")
    sides = (
        ("gateway", f"udpin://{ADDRESSES[0]}:14550", "--unsigned", "--out", "run"),
        ("controller", f"udpout://{ADDRESSES[0]}:14550"),
    )
    with ExitStack() as stack:

        def call() -> list[float]:
            started = []
            for name, (side, url, *more) in zip(NAMES, sides, strict=True):
                laglab = (sys.executable, "-m", "laglab", side, *options, "--endpoint", url, *more)
                process = subprocess.Popen(
                    ("ip", "netns", "exec", name, *laglab),
                    cwd=tmp_path,
                    stderr=subprocess.PIPE,
                    text=True,
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
    assert len(measured) >= 25
    assert 0.0 < median(measured) < 0.02


def test_the_measured_delay_is_what_netem_was_told(answers: Answers) -> None:
    told = (0.015, 0.025)
    for name, device, delay in zip(NAMES, DEVICES, told, strict=True):
        netem = ("root", "netem", "delay", f"{1e3 * delay:g}ms")
        needed("tc", "-n", name, "qdisc", "add", "dev", device, *netem)
    measured = answers()
    assert len(measured) >= 25
    assert sum(told) < median(measured) < sum(told) + 0.015
