"""A disk that fills up during a run: the robot is stopped, one line, exit 4, whole records."""

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

import laglab
from laglab_gateway import read_trace
from laglab_protocol import read_tlog

Start = Callable[..., "subprocess.Popen[str]"]
ListeningPort = Callable[["subprocess.Popen[str]"], str]
Laglab = Callable[..., subprocess.CompletedProcess[str]]

LONG = ("lab", "--duration", "3600")
HERE = ("--endpoint", "udpin://127.0.0.1:0")
SIDES = ("gateway", "controller")
FULL = (
    r"laglab: cannot record small/run/\S+ any further: (No space left on device|File too large): "
    "what was written up to here is whole; make room, then run again"
)
MOUNTED = "mount -t tmpfs -o size={size}k none small"
LIMITED = "ulimit -f {size}"
"""Where no file system may be mounted: no file may grow beyond that."""
AND_KEEP = '; "$@"; code=$?; cp -r small/. kept; exit $code'


def may_mount() -> bool:
    return subprocess.run(["unshare", "-rm", "true"], check=False).returncode == 0


class SmallDisk:
    """A folder `small` of a few kilobytes; what is in it at the end is then in `kept`."""

    def __init__(self, start: Start, folder: Path) -> None:
        self._start = start
        self.kept = folder / "kept"
        (folder / "small").mkdir()
        self.kept.mkdir()

    def start(self, *arguments: str, size: int = 150) -> "subprocess.Popen[str]":
        program = (sys.executable, "-m", "laglab", *arguments, "--out", "small/run")
        return self._started(size, *program)

    def _started(self, size: int, *program: str) -> "subprocess.Popen[str]":
        mounted = may_mount()
        script = (MOUNTED if mounted else LIMITED).format(size=size) + AND_KEEP
        namespace = ("unshare", "-rm") if mounted else ()
        return self._start(*namespace, "sh", "-c", script, "sh", *program)

    def in_python(self, script: str) -> "subprocess.Popen[str]":
        return self._started(150, sys.executable, "-c", script)

    def assert_whole(self) -> None:
        run = self.kept / "run"
        size = (run / "robot.tlog").stat().st_size
        assert size == sum(8 + len(frame.raw) for _, frame in read_tlog(run / "robot.tlog"))
        text = (run / "trace.csv").read_text()
        assert text.endswith("\n")
        assert len({line.count(",") for line in text.splitlines()}) == 1
        if (run / "summary.json").exists():
            json.loads((run / "summary.json").read_text())


@pytest.fixture
def small_disk(start_program: Start, tmp_path: Path) -> SmallDisk:
    return SmallDisk(start_program, tmp_path)


def said(process: "subprocess.Popen[str]", code: int) -> str:
    """On standard error, up to its end with this exit code."""
    _, errors = process.communicate(timeout=30)
    assert process.returncode == code, errors
    assert "Traceback" not in errors
    return errors


def assert_one_line(errors: str, line: str) -> None:
    """Besides warnings, and what was said of where it listens and whom it calls."""
    lines = [each for each in errors.splitlines() if each.startswith("laglab")]
    assert len(lines) == 1, errors
    assert re.fullmatch(line, lines[0]), errors


@pytest.mark.parametrize("transport", ["inline", "udp", "serial"])
def test_of_a_whole_run(small_disk: SmallDisk, transport: str) -> None:
    run = small_disk.start("run", *LONG, "--transport", transport)
    assert_one_line(said(run, 4), FULL)
    small_disk.assert_whole()
    assert read_trace(small_disk.kept / "run" / "trace.csv")["tick"][-1] > 100


IN_PYTHON = """
import laglab
try:
    laglab.run("lab-radio", {"duration": 30.0}, out="small/run")
except laglab.RunError as error:
    raise SystemExit(f"laglab: {error}")
"""


def test_in_python_it_is_what_broke_the_run(small_disk: SmallDisk) -> None:
    """Not that there was no room for its summary either."""
    assert_one_line(said(small_disk.in_python(IN_PYTHON), 1), FULL)
    small_disk.assert_whole()


def test_of_a_run_that_records_the_link_and_the_clock_too(small_disk: SmallDisk) -> None:
    options = ("lab-radio", "--pace", "realtime", "--speed", "20")
    assert_one_line(said(small_disk.start("run", *options), 4), FULL)
    small_disk.assert_whole()
    for name in ("link.csv", "timing.csv"):
        assert (small_disk.kept / "run" / name).read_text().endswith("\n")


@pytest.mark.parametrize("full", ["gateway", "controller"])
def test_of_one_side_alone(
    small_disk: SmallDisk, start: Start, listening_port: ListeningPort, full: str
) -> None:
    begin = {side: small_disk.start if side == full else start for side in SIDES}
    gateway = begin["gateway"]("gateway", *LONG, *HERE)
    met = f"udpout://127.0.0.1:{listening_port(gateway)}"
    station = begin["controller"]("controller", *LONG, "--endpoint", met)
    ends, other = (gateway, station) if full == "gateway" else (station, gateway)
    assert_one_line(said(ends, 4), FULL)
    assert "the other side failed" in other.communicate(timeout=20)[0]
    assert other.returncode == 4
    small_disk.assert_whole()


def test_in_front_of_a_real_robot(
    small_disk: SmallDisk, start: Start, listening_port: ListeningPort
) -> None:
    """Another gateway, on its own clock, is the robot: it is stopped."""
    own_clock = ("-n", "0", "-m", "0", "--pace", "realtime", "--speed", "4")
    robot = start("gateway", *LONG, *own_clock, *HERE)
    run = small_disk.start("run", *LONG, "--plant", f"udpout://127.0.0.1:{listening_port(robot)}")
    assert_one_line(said(run, 4), FULL)
    output, _ = robot.communicate(timeout=20)
    assert robot.returncode == 4
    assert "the other side failed" in output
    small_disk.assert_whole()


def test_when_only_the_figure_finds_no_room(small_disk: SmallDisk) -> None:
    if not may_mount():
        pytest.skip("no file system may be mounted here, in a namespace of our own")
    run = small_disk.start("run", "fig6", "--duration", "1", "--transport", "inline", size=120)
    line = "laglab: cannot write small/run/figure.png: No space left on device"
    assert_one_line(said(run, 4), line)
    small_disk.assert_whole()
    left = {path.name for path in (small_disk.kept / "run").iterdir()}
    record = {"trace.csv", "claims.csv", "arrivals.csv", "robot.tlog"}
    assert left == {"scenario.toml", "summary.json", *record}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that is to be exported."""
    folder = tmp_path_factory.mktemp("runs") / "whole"
    laglab.run("lab", {"duration": 3.0}, out=folder)
    return folder


@pytest.mark.parametrize("name", ["csv", "parquet", "mat", "mcap"])
def test_of_an_export(small_disk: SmallDisk, whole: Path, name: str) -> None:
    export = small_disk.start("export", str(whole), "--format", name, size=20)
    place = r"small/run(/ticks\.\w+)?"
    line = rf"laglab: cannot write {place}: (No space left on device|File too large)"
    assert_one_line(said(export, 4), line)
    assert not (small_disk.kept / "run").exists()


@pytest.mark.skipif(not may_mount(), reason="where a process may write less, none compiles")
def test_of_fmus(small_disk: SmallDisk) -> None:
    build = small_disk.start("fmu", "build", size=20)
    assert_one_line(said(build, 4), r"laglab: small/run/\w+\.fmu: No space left on device")
    assert not list((small_disk.kept / "run").iterdir())


@pytest.mark.parametrize("name", ["summary.json", "figure.png"])
def test_when_somebody_else_takes_the_place_meanwhile(
    start: Start, tmp_path: Path, name: str
) -> None:
    pace = ("--pace", "realtime", "--speed", "10")
    run = start("run", "lab", *pace, "--transport", "inline", "--out", "run")
    while not (tmp_path / "run" / "timing.csv").exists():
        time.sleep(0.02)
    (tmp_path / "run" / name).mkdir()
    assert_one_line(said(run, 4), f"laglab: cannot write run/{name}: Is a directory")
    assert read_trace(tmp_path / "run" / "trace.csv")["tick"][-1] == 2000
