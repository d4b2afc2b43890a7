"""Runs of a study that fail, or kill whoever makes them, cost the others nothing."""

import os
import re
import subprocess
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import laglab as lab
from laglab.errors import RunError
from laglab.studies.sweep.cells.tasks import Task, done
from laglab.studies.sweep.loading import load_study
from laglab.studies.workers import Processes
from laglab.version import code_version

from .studying import SMALL, write_deadly_study

Laglab = Callable[..., subprocess.CompletedProcess[str]]


def test_a_job_that_kills_whoever_does_it_is_given_up() -> None:
    with Processes(1) as processes:
        deadly = processes.submit(os._exit, 7)
        harmless = processes.submit(abs, -3)
        with pytest.raises(RunError, match="exit code 7 and no word, three times at the same job"):
            deadly.result(40)
        assert harmless.result(20) == 3


def test_an_executor_that_is_shut_down_is_told_in_a_line() -> None:
    study = lab.Study(lab.load("lab"), [1], {"duration": [0.1]})
    with ThreadPoolExecutor(1) as over:
        pass
    with pytest.raises(RunError, match="whoever was to do the rest failed or is gone"):
        lab.sweep(study, executor=over)


@pytest.mark.slow
def test_a_run_that_kills_its_worker_is_named(laglab: Laglab, tmp_path: Path) -> None:
    write_deadly_study(tmp_path)
    swept = laglab("sweep", "mortal.toml", "--workers", "2", "--out", "out")
    assert swept.returncode == 4
    why = r"estimator\.options\.at = 10: the worker \d process ended with exit code 3 and no word"
    assert re.search(why, swept.stderr), swept.stderr
    assert "Traceback" not in swept.stderr
    assert "and 1 more such" in swept.stderr
    frame = lab.open_study(tmp_path / "out").to_pandas()
    assert list(frame["estimator.options.at"]) == [500, 500]


def test_what_nobody_foresaw_names_its_cell(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    first, second, *_ = load_study(str(tmp_path / "small.toml")).cells()
    monkeypatch.setattr("laglab.studies.sweep.cells.tasks.computed", lambda _: 1 // 0)
    assert done(Task((first, second), code_version())) == [
        f"{cell.place}: ZeroDivisionError('integer division or modulo by zero')"
        for cell in (first, second)
    ]
