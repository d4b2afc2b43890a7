"""Virtual serial ports behave as real ones: their pace, one holder, pulled cables, new programs."""

import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab_gateway import read_trace

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Start = Callable[..., "subprocess.Popen[str]"]

BAUD = 57600
TICK_BYTES = 60 + 17
"""LAGLAB_MEASUREMENT and LAGLAB_TICK, their last bytes not zero."""
ANSWER_BYTES = 88 + 35


def wait_until(done: Callable[[], bool]) -> None:
    while not done():
        time.sleep(0.02)


def rows(trace: Path) -> int:
    return trace.read_bytes().count(b"\n") if trace.exists() else 0


def ended(process: "subprocess.Popen[str]", within: float) -> str:
    """What it said on standard error; it has ended in time, and without a traceback."""
    _, errors = process.communicate(timeout=within)
    assert "Traceback" not in errors
    return errors


@pytest.mark.slow
def test_lockstep_across_a_line_of_57600_baud(start: Start, laglab: Laglab, tmp_path: Path) -> None:
    options = ("lab", "-m", "0", "--duration", "0.4")
    assert laglab("run", *options, "--transport", "inline", "--out", "calm").returncode == 0
    line = start("serial", "robot", "station", "--baud", str(BAUD))
    wait_until((tmp_path / "station").exists)
    sides = [
        start("gateway", *options, "--endpoint", f"serial://robot:{BAUD}", "--out", "across"),
        start("controller", *options, "--endpoint", f"serial://station:{BAUD}"),
    ]
    for side in sides:
        ended(side, 30)
        assert side.returncode == 0
    line.send_signal(signal.SIGINT)
    report, _ = line.communicate(timeout=10)
    assert line.returncode == 130
    there, back = (int(found) for found in re.findall(r": (\d+) bytes$", report, re.MULTILINE))
    assert there > 0.9 * 41 * TICK_BYTES
    assert back > 0.9 * 41 * ANSWER_BYTES
    assert not list(tmp_path.glob("robot")), "the ports go with the line"
    traces = [(tmp_path / name / "trace.csv").read_bytes() for name in ("calm", "across")]
    assert traces[0] == traces[1]


def test_in_real_time_an_answer_takes_as_long_as_its_bytes(start: Start, tmp_path: Path) -> None:
    options = ("lab", "-m", "0", "--pace", "realtime", "--speed", "0.2", "--duration", "0.4")
    start("serial", "robot", "station", "--baud", str(BAUD))
    wait_until((tmp_path / "station").exists)
    gateway = start("gateway", *options, "--endpoint", f"serial://robot:{BAUD}", "--out", "run")
    start("controller", *options, "--endpoint", f"serial://station:{BAUD}")
    ended(gateway, 40)
    assert gateway.returncode == 0
    timing = (tmp_path / "run" / "timing.csv").read_text().splitlines()[1:]
    answers = sorted(float(answer) for _, _, answer in (row.split(",") for row in timing) if answer)
    at_the_rate = (TICK_BYTES + ANSWER_BYTES) * 10 / BAUD
    assert 0.95 * at_the_rate < answers[0] < at_the_rate + 0.01


def test_a_port_changes_hands(start: Start, laglab: Laglab, tmp_path: Path) -> None:
    """A second controller is refused; the first one dies; the next takes over at the same port."""
    options = ("lab", "--silence", "20")
    gateway = start("gateway", *options, "--endpoint", "pty://robot", "--out", "run")
    wait_until((tmp_path / "robot").exists)
    link = ("--endpoint", f"serial://robot:{BAUD}")
    first = start("controller", *options, *link)
    wait_until(lambda: rows(tmp_path / "run" / "trace.csv") > 100)
    first.send_signal(signal.SIGSTOP)
    refused = laglab("controller", *options, *link)
    assert refused.returncode == 2
    assert "another program holds the port" in refused.stderr
    assert len(refused.stderr.splitlines()) == 1
    first.kill()
    first.wait()
    second = start("controller", *options, *link)
    ended(gateway, 40)
    ended(second, 10)
    assert (gateway.returncode, second.returncode) == (0, 0)
    assert read_trace(tmp_path / "run" / "trace.csv")["tick"][-1] == 2000


def test_an_unplugged_port_ends_the_controller(start: Start, tmp_path: Path) -> None:
    options = ("lab", "--duration", "3600")
    gateway = start("gateway", *options, "--endpoint", "pty://robot", "--out", "run")
    wait_until((tmp_path / "robot").exists)
    station = start("controller", *options, "--endpoint", f"serial://robot:{BAUD}")
    wait_until(lambda: rows(tmp_path / "run" / "trace.csv") > 50)
    gateway.kill()
    errors = ended(station, 20)
    assert station.returncode == 4
    assert "the far end is gone" in errors.splitlines()[-1]


def test_ctrl_c_while_a_port_is_unplugged(start: Start, tmp_path: Path) -> None:
    """There is nobody to tell; it is an interrupt all the same."""
    line = start("serial", "robot", "station")
    wait_until((tmp_path / "station").exists)
    station = start(
        "controller", "lab", "--silence", "30", "--endpoint", f"serial://station:{BAUD}"
    )
    assert station.stderr is not None
    assert "waiting for the robot" in station.stderr.readline()
    line.send_signal(signal.SIGINT)
    assert "waiting for it to come back" in station.stderr.readline()
    line.wait(10)
    time.sleep(0.3)
    station.send_signal(signal.SIGINT)
    errors = ended(station, 10)
    assert station.returncode == 130
    assert errors.splitlines() == ["laglab: interrupted"]


@pytest.mark.parametrize("pace", [pytest.param("lockstep", marks=pytest.mark.slow), "realtime"])
def test_a_controller_that_stops_reading_is_noticed(
    start: Start, tmp_path: Path, pace: str
) -> None:
    options = ("lab", "--duration", "3600", "--pace", pace)
    gateway = start("gateway", *options, "--endpoint", "pty://robot", "--out", "run")
    wait_until((tmp_path / "robot").exists)
    station = start("controller", *options, "--endpoint", f"serial://robot:{BAUD}")
    wait_until(lambda: rows(tmp_path / "run" / "trace.csv") > 50)
    station.send_signal(signal.SIGSTOP)
    errors = ended(gateway, 30)
    assert gateway.returncode == 4
    (said,) = (line for line in errors.splitlines() if line.startswith("laglab:"))
    assert "has been silent since tick" in said


@pytest.mark.slow
def test_a_station_is_replaced_while_the_line_is_full(start: Start, tmp_path: Path) -> None:
    """Nobody reads for longer than a full queue is waited for; but no longer than is allowed."""
    options = ("lab", "--duration", "10", "--pace", "realtime", "--silence", "9")
    gateway = start("gateway", *options, "--endpoint", "pty://robot", "--out", "run")
    wait_until((tmp_path / "robot").exists)
    serial_station = (*options, "--endpoint", f"serial://robot:{BAUD}")
    station = start("controller", *serial_station, "--out", "first")
    wait_until(lambda: rows(tmp_path / "run" / "trace.csv") > 50)
    station.kill()
    station.wait(10)
    time.sleep(2.2)
    station = start("controller", *serial_station, "--out", "second")
    for side in (gateway, station):
        ended(side, 30)
        assert side.returncode == 0
