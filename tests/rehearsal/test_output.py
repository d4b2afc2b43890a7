"""Whatever becomes of the output: the run is whole, no traceback, and the exit code tells."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from laglab_gateway import read_trace

RUN = (sys.executable, "-m", "laglab", "run", "fig6", "--duration", "0.3", "--out", "run")
Ended = subprocess.CompletedProcess[str]
CLOSING = """
import io, sys

class Robot:
    def __init__(self, sample_time, start, seed):
        self.start, self.steps = start, 0

    def read(self):
        return (*self.start, *self.start, 0.0, 0.0)

    def step(self, v, omega):
        self.steps += 1
        if self.steps == 20:
            {line}

    def place(self, x, y, theta):
        pass
"""


def assert_whole(folder: Path, ticks: int = 30) -> None:
    assert read_trace(folder / "trace.csv")["tick"].tolist() == list(range(ticks + 1))
    assert json.loads((folder / "summary.json").read_text())["ticks"] == ticks
    assert (folder / "figure.png").read_bytes().startswith(b"\x89PNG")
    assert b"laglab" not in (folder / "robot.tlog").read_bytes()


@pytest.fixture
def shell(tmp_path: Path) -> Callable[..., Ended]:
    """The command, with its output as the shell's `redirections` have it."""

    def call(redirections: str, *command: str) -> Ended:
        script = f'exec "$@" {redirections}'
        return subprocess.run(
            ["sh", "-c", script, "sh", *command],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )

    return call


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_what_the_encoding_lacks_is_spelled_out(
    encoding: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONIOENCODING", encoding)
    ended = subprocess.run(
        [*RUN, "--transport", "inline"], cwd=tmp_path, capture_output=True, check=False
    )
    output = ended.stdout.decode(encoding)
    assert (ended.returncode, ended.stderr) == (0, b"")
    assert "did not converge: at the end rho = 2.52 m, theta error = 1.01 rad" in output
    assert "?" not in output
    assert_whole(tmp_path / "run")


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_closed_streams_change_nothing_else(
    closed: str, shell: Callable[..., Ended], tmp_path: Path
) -> None:
    """A closed descriptor is that of the next file opened: the text would go there."""
    transport = "udp" if closed == "<&- >&- 2>&-" else "inline"
    ended = shell(closed, *RUN, "--transport", transport)
    assert ended.returncode == 0
    assert ended.stderr == ""
    assert ("did not converge" in ended.stdout) == (">&- " not in f"{closed} ".replace("2>", ""))
    assert_whole(tmp_path / "run")


def test_an_error_without_a_place_to_say_it_still_has_its_exit_code(
    shell: Callable[..., Ended],
) -> None:
    command = (sys.executable, "-m", "laglab", "run", "fig9")
    for lost in ("2>&-", "2>/dev/full"):
        ended = shell(lost, *command)
        assert (ended.returncode, ended.stdout, ended.stderr) == (2, "", "")


def test_a_full_disk_behind_the_output_is_one_line_after_the_run(
    shell: Callable[..., Ended], tmp_path: Path
) -> None:
    ended = shell(">/dev/full", *RUN, "--transport", "inline")
    assert ended.returncode == 4
    assert ended.stderr == "laglab: cannot write the output: No space left on device\n"
    assert_whole(tmp_path / "run")


def test_where_nothing_can_be_said_the_code_says_it(shell: Callable[..., Ended]) -> None:
    laglab = (sys.executable, "-m", "laglab")
    assert shell(">/dev/full 2>/dev/full", *laglab, "estimators").returncode == 4


@pytest.mark.slow
@pytest.mark.parametrize(
    "line",
    [
        "sys.stdout.close()",
        "sys.stdout.buffer.close()",
        "sys.stdout.detach()",
        "sys.stdout.buffer.detach()",
        "sys.stdout = io.TextIOWrapper(sys.stdout.detach())",
        "sys.stderr.close()",
    ],
)
def test_a_robot_that_closes_the_output_closes_it_to_nobody(line: str, tmp_path: Path) -> None:
    (tmp_path / "closing.py").write_text(CLOSING.format(line=line))
    command = [*RUN, "--transport", "inline", "--set", "plant.kind=closing:Robot"]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert "did not converge" in ended.stdout
    assert_whole(tmp_path / "run")


def test_where_the_system_s_output_was_closed_it_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "closing.py").write_text(CLOSING.format(line="sys.__stdout__.close()"))
    command = [*RUN, "--transport", "inline", "--set", "plant.kind=closing:Robot"]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    said = "laglab: cannot write the output: Bad file descriptor\n"
    assert (ended.returncode, ended.stderr) == (4, said)
    assert_whole(tmp_path / "run")


@pytest.mark.parametrize("lines", [0, 5])
def test_a_reader_that_goes_away_does_not_end_the_run(lines: int, tmp_path: Path) -> None:
    """It reads so many pieces of what a terminal would show, the progress with it."""
    process = subprocess.Popen(
        [*RUN, "--duration", "10"],
        cwd=tmp_path,
        env=os.environ | {"FORCE_COLOR": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert process.stdout is not None
    for _ in range(lines):
        os.read(process.stdout.fileno(), 10)
    process.stdout.close()
    try:
        assert process.wait(30) == 141
    finally:
        process.kill()
    assert_whole(tmp_path / "run", ticks=1000)
