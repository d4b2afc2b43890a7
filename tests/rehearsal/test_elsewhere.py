"""Machines that lack something: FMPy, or all that Windows lacks."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import laglab

HIDING = """
import os, select, signal, socket, sys

class Without:
    def __init__(self, finder):
        self.finder = finder

    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] not in {modules}:
            return self.finder.find_spec(name, path, target)

    def __getattr__(self, name):
        return getattr(self.finder, name)

sys.meta_path[:] = map(Without, sys.meta_path)
for name in {modules}:
    sys.modules.pop(name, None)
for module, name in {names}:
    if hasattr(globals()[module], name):
        delattr(globals()[module], name)
"""
"""As a `sitecustomize`, which every Python started from here runs first, children's too."""

TERMINALS = {"tty", "pty", "termios", "fcntl"}
OF_POSIX = (
    *(("os", name) for name in ("sched_yield", "openpty", "ttyname", "getuid", "getloadavg")),
    ("socket", "MSG_DONTWAIT"),
    ("select", "poll"),
    ("select", "epoll"),
    ("signal", "SIGHUP"),
)
Python = Callable[..., subprocess.CompletedProcess[str]]


def without(folder: Path, modules: set[str], names: tuple[tuple[str, str], ...] = ()) -> Python:
    """Runs `python ARGUMENTS` in the folder, where these modules and names are not."""
    hiding = folder / "hiding"
    hiding.mkdir()
    (hiding / "sitecustomize.py").write_text(HIDING.format(modules=modules, names=names))

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *arguments],
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(hiding)},
            capture_output=True,
            text=True,
            timeout=50,
            check=False,
        )

    return run


@pytest.fixture
def windows(tmp_path: Path) -> Python:
    """As far as Windows lacks what POSIX has."""
    return without(tmp_path, TERMINALS, OF_POSIX)


@pytest.fixture
def no_fmpy(tmp_path: Path) -> Python:
    return without(tmp_path, {"fmpy"})


def one_line(ended: subprocess.CompletedProcess[str]) -> str:
    assert ended.returncode == 2, ended.stderr
    (line,) = ended.stderr.splitlines()
    return line


def test_without_terminals_every_module_but_theirs_is_imported(windows: Python) -> None:
    """Each on its own: one that fails says so."""
    script = """
import importlib, importlib.util, pkgutil
print(importlib.util.find_spec("termios"))
for top in ("fmu", "protocol", "conformance", "gateway", "control", "station", ""):
    package = importlib.import_module("laglab" + (top and "_" + top))
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if not module.name.endswith("__main__"):
            try:
                importlib.import_module(module.name)
            except ImportError as error:
                print(module.name, error)
"""
    ended = windows("-c", script)
    assert ended.returncode == 0, ended.stderr
    hidden, *failed = ended.stdout.splitlines()
    assert hidden == "None"
    (only,) = failed
    assert only.startswith("laglab_protocol.endpoints.tty ")


ENDINGS = """
import sys
from laglab.command import main

for line in sys.argv[1:]:
    try:
        main(line.split())
    except SystemExit as ended:
        print(ended.code, file=sys.stderr)
"""


def endings(python: Python, *commands: str) -> list[tuple[tuple[str, ...], str]]:
    """Of each command, in one process: the lines on standard error, and the exit code."""
    found: list[tuple[tuple[str, ...], str]] = []
    said: list[str] = []
    for line in python("-c", ENDINGS, *commands).stderr.splitlines():
        if line.isdigit():
            found.append((tuple(said), line))
            said = []
        else:
            said.append(line)
    assert not said, said
    return found


def test_without_terminals_all_but_serial_works(windows: Python) -> None:
    commands = (
        "run lab --duration 0.5 --transport inline --out inline",
        "run lab --duration 0.5 --out udp",
        "run lab --duration 0.5 --pace realtime --speed 2 --out realtime",
        "consistency --duration 0.5 --seeds 2 --workers 2",
    )
    found = endings(windows, *commands)
    assert [code for _, code in found] == ["0"] * len(commands), found
    assert "Traceback" not in str(found)


def test_without_terminals_serial_says_so(windows: Python) -> None:
    commands = (
        "run fig6 --transport serial",
        "gateway fig6 --endpoint pty://port",
        "gateway fig6 --plant /dev/ttyUSB0,57600",
        "controller fig6 --endpoint serial:///dev/ttyUSB0:57600",
        "conform serial:///dev/ttyUSB0:57600 --side robot",
        "serial port-1 port-2",
        "bench loop --link serial --rounds 1",
    )
    found = endings(windows, *commands)
    assert len(found) == len(commands)
    for (line,), code in found:
        assert "this system has no serial ports and ptys" in line
        assert code == "2"


def test_what_an_export_needs_is_said(tmp_path: Path) -> None:
    """And without any of it there is CSV."""
    bare = without(tmp_path, {"pyarrow", "scipy", "mcap_ros2", "mcap"})
    laglab.run("fig6", {"duration": 0.1}, out=tmp_path / "run")
    needed = {"parquet": "pyarrow", "mat": "scipy", "ros2bag": "mcap_ros2"}
    *found, csv = endings(bare, *(f"export run --format {name}" for name in (*needed, "csv")))
    for missing, ((line,), code) in zip(needed.values(), found, strict=True):
        assert f"{missing} is not installed here: pip install 'laglab[export]'" in line
        assert code == "2"
    assert csv == ((), "0")
    assert {path.name for path in tmp_path.iterdir()} == {"hiding", "run", "run-csv"}


@pytest.mark.slow
def test_without_fmpy_runs_are_compared_and_replayed(no_fmpy: Python, laglab: Python) -> None:
    """And what steps the FMU says what to install, to somebody who has a wheel and no clone."""
    made = laglab("run", "fig6", "--duration", "0.5", "--transport", "inline", "--out", "run")
    assert made.returncode == 0, made.stderr
    for arguments in (
        ("compare", "run", "run", "--out", "both.png"),
        ("replay", "run/robot.tlog", "--estimator", "delayed-ekf"),
        ("replay", "run", "--estimator", "delayed-ekf"),
    ):
        ended = no_fmpy("-m", "laglab", *arguments)
        assert ended.returncode == 0, ended.stderr
    for arguments in (("run", "fig6"), ("gateway", "fig6"), ("fmu", "build"), ("errata",)):
        line = one_line(no_fmpy("-m", "laglab", *arguments))
        assert "fmpy is not installed here: pip install 'laglab[" in line


IN_PYTHON = """
import laglab
try:
    {}
except laglab.LaglabError as error:
    print(error)
"""


@pytest.mark.parametrize(
    ("missing", "script"),
    [
        ("fmpy", "laglab.run('fig6', {'duration': 0.1})"),
        ("matplotlib", "laglab.run('fig6', {'duration': 0.1}).figure()"),
        ("matplotlib", "laglab.run('fig6', {'duration': 0.1}, out='run')"),
    ],
)
def test_in_python_what_is_missing_is_said_as_on_the_command_line(
    missing: str, script: str, tmp_path: Path
) -> None:
    ended = without(tmp_path, {missing})("-c", IN_PYTHON.format(script))
    assert ended.returncode == 0, ended.stderr
    assert f"{missing} is not installed here: pip install 'laglab[" in ended.stdout
    assert not (tmp_path / "run").exists()
