"""Runs of the real command, in a process of its own or in this one."""

import json
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from laglab.command import main

Start = Callable[..., "subprocess.Popen[str]"]


ROOT = Path(__file__).parents[2]


Laglab = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def laglab_in() -> Callable[[Path], Laglab]:
    """``laglab ARGUMENTS`` as a user runs it, in that folder."""

    def call(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "laglab", *arguments],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )

    return lambda folder: partial(call, folder)


@pytest.fixture
def laglab(tmp_path: Path, laglab_in: Callable[[Path], Laglab]) -> Laglab:
    """The same in an empty folder."""
    return laglab_in(tmp_path)


class Ended(NamedTuple):
    """How a command ended, and what it had said."""

    code: int
    out: str
    err: str


def _ended(captured: pytest.CaptureFixture[str], *arguments: object) -> Ended:
    captured.readouterr()
    with pytest.raises(SystemExit) as ended:
        main([str(each) for each in arguments])
    assert isinstance(ended.value.code, int)
    return Ended(ended.value.code, *captured.readouterr())


@pytest.fixture
def ended(capsys: pytest.CaptureFixture[str]) -> Callable[..., Ended]:
    """``laglab ARGUMENTS`` in this process, where the current directory is."""
    return partial(_ended, capsys)


@pytest.fixture
def ended_here(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Ended]:
    """The same in an empty folder, and with what the processes said that it started: `laglab`,
    where its own process is not what is tested, for that takes a second to start."""
    monkeypatch.chdir(tmp_path)
    return partial(_ended, capfd)


@pytest.fixture
def refused(ended: Callable[..., Ended]) -> Callable[..., str]:
    """The one line with which ``laglab ARGUMENTS`` is refused."""

    def call(*arguments: object, code: int = 2) -> str:
        said = ended(*arguments)
        assert (said.code, said.out) == (code, ""), said
        (line,) = said.err.splitlines()
        assert line.startswith("laglab: ")
        return line

    return call


@pytest.fixture
def rehearsed(tmp_path: Path, ended: Callable[..., Ended]) -> Callable[..., dict[str, Any]]:
    """Run a scenario inline and give its summary; the results are in ``tmp_path / "run"``."""

    def call(*arguments: str, exit_code: int = 0) -> dict[str, Any]:
        out = tmp_path / "run"
        said = ended("run", *arguments, "--transport", "inline", "--out", out, "--force")
        assert said.code == exit_code, said
        summary: dict[str, Any] = json.loads((out / "summary.json").read_text())
        return summary

    return call


@pytest.fixture
def start(start_program: Start) -> Start:
    """Start ``laglab ARGUMENTS`` in the background; whatever still runs at the end is ended."""
    return partial(start_program, sys.executable, "-m", "laglab")
