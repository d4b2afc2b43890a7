"""What the command shows on a terminal, wide or narrow, and what it does not say elsewhere."""

import fcntl
import math
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from pathlib import Path
from typing import NamedTuple

import pytest

import laglab
from laglab import progress
from laglab.progress import at_a_glance, progress_of_study, tracked
from laglab.results.station import StationGlance
from laglab.runs.glance import Glance, Glances
from laglab.scenario import load
from laglab_gateway import ArrivalRow, ClaimRow, LinkRow, TraceRow
from laglab_protocol import read_tlog

RUN = ("run", "lab-radio", "--transport", "inline", "--out", "run")
LOCKSTEP = (*RUN, "--duration", "2")
BY_THE_CLOCK = (*RUN, "--duration", "3", "--pace", "realtime", "--speed", "3")

CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
COLOR = re.compile(r"\x1b\[[0-9;]*3[0-9][0-9;]*m")


class Shown(NamedTuple):
    raw: str
    lines: list[str]
    """Whatever stood in a line at some time."""


def on_a_terminal(folder: Path, columns: int, *arguments: str, **environment: str) -> Shown:
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 30, columns, 0, 0))
    known = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")}
    process = subprocess.Popen(
        [sys.executable, "-m", "laglab", *arguments],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=slave,
        stderr=slave,
        env=known | {"TERM": "xterm-256color"} | environment,
    )
    os.close(slave)
    read = b""
    try:
        while piece := os.read(master, 1 << 16):
            read += piece
    except OSError:
        pass  # so a terminal says that nobody writes to it any more
    finally:
        os.close(master)
    try:
        assert process.wait(30) == 0, read
    finally:
        process.kill()
    raw = read.decode()
    return Shown(raw, re.split(r"[\r\n]+", CONTROL.sub("", raw)))


@pytest.fixture(scope="module")
def wide(tmp_path_factory: pytest.TempPathFactory) -> Shown:
    """A run on a terminal of a hundred columns."""
    return on_a_terminal(tmp_path_factory.mktemp("wide"), 100, *LOCKSTEP)


@pytest.mark.parametrize("columns", [100, 60, 40])
def test_progress_tells_rate_and_time_to_go_as_far_as_there_is_room(
    columns: int, wide: Shown, tmp_path: Path
) -> None:
    shown = wide if columns == 100 else on_a_terminal(tmp_path, columns, *LOCKSTEP)
    progress = [line for line in shown.lines if line.startswith("lab-radio") and "%" in line]
    assert progress
    assert all(len(line.rstrip()) <= columns for line in progress)
    assert any("200/200" in line for line in progress) == (columns > 40)
    assert any("tick/s" in line for line in progress) == (columns > 80)
    longest = max(map(len, (line for line in shown.lines if line[:8] == "measurem")))
    assert longest <= columns


@pytest.mark.parametrize("columns", [100, 44])
def test_by_the_clock_one_line_says_how_the_run_is(columns: int, tmp_path: Path) -> None:
    shown = on_a_terminal(tmp_path, columns, *BY_THE_CLOCK)
    (*_, last) = (line for line in shown.lines if line.startswith("lab-radio  "))
    assert len(last) <= columns
    assert re.search(r"ρ [\d.]+ m .*(drives|stopped)$", last.rstrip())
    told = re.search(r"σ [\d.]+ m  delays \d+, \d+  lost [1-9]\d*  ", last)
    assert bool(told) == (columns == 100)


def test_without_colour_where_that_is_asked_for(wide: Shown, tmp_path: Path) -> None:
    assert COLOR.search(wide.raw)
    assert not COLOR.search(on_a_terminal(tmp_path, 100, *LOCKSTEP, NO_COLOR="1").raw)


@pytest.mark.parametrize("arguments", [LOCKSTEP, BY_THE_CLOCK], ids=["lockstep", "realtime"])
def test_a_pipe_gets_the_results_alone(arguments: tuple[str, ...], tmp_path: Path) -> None:
    ended = subprocess.run(
        [sys.executable, "-m", "laglab", *arguments],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert "\x1b" not in ended.stdout + ended.stderr
    assert "to go" not in ended.stderr
    assert max(map(len, ended.stdout.splitlines()[:12])) <= 80


def test_a_log_gets_a_line_now_and_then(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> None:
        assert list(tracked("abc", 3, "letters", "letter")) == ["a", "b", "c"]
        with progress_of_study("delays", 40, 1.0) as told:
            for _ in range(4):
                told(10, 0.25)
        with progress_of_study("unshown", 40, 1.0, shown=False) as told:
            told(10, 0.25)

    work()
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(progress, "LOGGED", 0.0)
    work()
    lines = "letters: 1 of 3", "letters: 2 of 3", *(f"delays: {n} of 40" for n in (10, 20, 30))
    assert capsys.readouterr() == ("", "".join(f"{line}\n" for line in lines))


def test_what_matters_least_is_left_out_first() -> None:
    scenario, glance = load("lab"), Glance(1.234, 0.0123, (10, 21), 12, "drives")
    whole = "lab  5.0 of 20 s  ρ 1.23 m  σ 0.012 m  delays 10, 21  lost 12  drives"
    assert at_a_glance(scenario, 500, glance, 80) == whole
    narrower = [at_a_glance(scenario, 500, glance, width) for width in (69, 50, 30, 8)]
    assert narrower == [
        "lab  5.0 of 20 s  ρ 1.23 m  delays 10, 21  lost 12  drives",
        "lab  5.0 of 20 s  ρ 1.23 m  drives",
        "lab  ρ 1.23 m  drives",
        "lab  ρ ",
    ]


def test_a_glance_is_what_was_recorded_last() -> None:
    glances = Glances(load("lab"))
    assert glances.now() is None
    row = TraceRow(0, 0.0, 3.0, 4.0, *[None] * 11)
    glances.row(row)
    assert glances.now() == Glance(5.0, None, (None, None), 0, "waits")
    glances.arrivals([ArrivalRow("command", 0, 10, 0.1), ArrivalRow("measurement", 0, 21, 0.21)])
    glances.claims([ClaimRow(0, 0.0, 9e-4, 0, 0, 16e-4, 0, 0)])
    glances.link([LinkRow("command", 1, 0, 0, 50, fate, 0.0) for fate in ("lost", "delivered")])
    glances.row(row._replace(time=0.5, x=None, y=None, x_meas=0.0, y_meas=1.0))
    assert glances.now() == Glance(1.0, pytest.approx(0.05), (10, 21), 1, "drives")
    glances.arrivals([ArrivalRow("command", 0, 50, 0.5, "stale")])
    glances.row(row._replace(time=0.6))
    assert glances.now().state == "stopped"


def test_a_station_alone_tells_what_it_knows(tmp_path: Path) -> None:
    scenario = load("lab", {"duration": 1.0})
    run = laglab.run(scenario, out=tmp_path / "run")
    glance = StationGlance(scenario)
    assert glance.now() is None
    for _, frame in read_tlog(tmp_path / "run" / "robot.tlog"):
        glance.said([frame.raw])
    last = {name: column[-1] for name, column in run.trace.items()}
    told = glance.now()
    assert told is not None
    assert told.rho == pytest.approx(math.hypot(last["x_est"], last["y_est"]))
    claimed = run.claims["p_xx"][-1] + run.claims["p_yy"][-1]
    assert told.sigma == pytest.approx(math.sqrt(claimed))
    assert (told.delays, told.lost, told.state) == ((10, 20), None, "drives")
