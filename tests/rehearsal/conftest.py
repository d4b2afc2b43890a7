"""Runs of the real command, in a process of its own or in this one."""

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from laglab.command import main

Start = Callable[..., "subprocess.Popen[str]"]


ROOT = Path(__file__).parents[2]


@pytest.fixture
def bare_clone(tmp_path: Path) -> Path:
    """The files that git tracks, and no others."""
    clone = tmp_path / "clone"
    tracked = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True)
    for name in filter(None, tracked.split("\0")):
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, clone / name)
    return clone


@pytest.fixture
def laglab(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """``laglab ARGUMENTS`` as a user runs it, in an empty folder."""

    def call(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "laglab", *arguments],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )

    return call


@pytest.fixture
def rehearsed(tmp_path: Path) -> Callable[..., dict[str, Any]]:
    """Run a scenario inline and give its summary; the results are in ``tmp_path / "run"``."""

    def call(*arguments: str, exit_code: int = 0) -> dict[str, Any]:
        out = tmp_path / "run"
        with pytest.raises(SystemExit) as ended:
            main(["run", *arguments, "--transport", "inline", "--out", str(out)])
        assert ended.value.code == exit_code
        summary: dict[str, Any] = json.loads((out / "summary.json").read_text())
        return summary

    return call


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Start ``laglab ARGUMENTS`` in the background; whatever still runs at the end is ended."""
    running: list[subprocess.Popen[str]] = []

    def call(*arguments: str) -> "subprocess.Popen[str]":
        process = subprocess.Popen(
            [sys.executable, "-m", "laglab", *arguments],
            cwd=tmp_path,
            stderr=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        running.append(process)
        return process

    yield call
    for process in running:
        process.kill()
        process.communicate()


@pytest.fixture
def listening_port() -> Callable[["subprocess.Popen[str]"], str]:
    """The UDP port on loopback that a gateway in the background says it listens on."""

    def read(gateway: "subprocess.Popen[str]") -> str:
        assert gateway.stderr is not None
        line = gateway.stderr.readline()
        found = re.search(r"listening on udpin://127\.0\.0\.1:(\d+)", line)
        assert found, line
        return found[1]

    return read
