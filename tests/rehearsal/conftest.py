"""Runs of the real command, in a process of its own or in this one."""

import json
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from laglab.command import main

Start = Callable[..., "subprocess.Popen[str]"]


ROOT = Path(__file__).parents[2]


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
            main(["run", *arguments, "--transport", "inline", "--out", str(out), "--force"])
        assert ended.value.code == exit_code
        summary: dict[str, Any] = json.loads((out / "summary.json").read_text())
        return summary

    return call


@pytest.fixture
def start(start_program: Start) -> Start:
    """Start ``laglab ARGUMENTS`` in the background; whatever still runs at the end is ended."""
    return partial(start_program, sys.executable, "-m", "laglab")
