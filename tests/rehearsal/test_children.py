"""Processes of our own that end as nobody expects: whoever waits for them is told."""

import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from queue import Queue

import pytest

from laglab.errors import RunError
from laglab.runs.processes.child import Child, Letter, _read
from laglab.runs.processes.reports import Computed, Ended
from laglab.studies.workers import shared_out
from laglab_gateway import StationSilentError

DYING = """\
import os, sys
sys.stdout.write('["Computed", "half of an')
sys.stdout.flush()
os.kill(os.getpid(), {signal})
"""


def test_a_line_of_somebody_elses_is_passed_over() -> None:
    """What Python does at its start may print."""
    program = """print('hello'); print('{"type": "Computed", "answer": ""}')"""
    command = [sys.executable, "-c", program]
    inbox: Queue[Letter] = Queue()
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        _read(Child("worker", process), inbox)
    reports = [inbox.get_nowait().report for _ in range(2)]
    assert reports == [
        Computed(b""),
        Ended("the worker process ended with exit code 0 and no word"),
    ]
    assert inbox.empty()


def test_an_answer_that_cannot_be_read_is_told() -> None:
    """Pickle refuses what needs more than one argument to be made."""
    with pytest.raises(RunError, match="answer of a job cannot be read: TypeError"):
        list(shared_out(partial(StationSilentError, None), [1.0, 2.0], 1))


@pytest.mark.parametrize(("signal", "called"), [(9, "SIGKILL"), (40, "signal 40")])
def test_one_that_dies_in_the_middle_of_a_report_has_ended(signal: int, called: str) -> None:
    command = [sys.executable, "-c", DYING.format(signal=signal)]
    inbox: Queue[Letter] = Queue()
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        _read(Child("worker", process), inbox)
    assert inbox.get_nowait().report == Ended(f"the worker process was killed by {called}")
    assert inbox.empty()


def test_where_no_worker_can_be_started_nobody_waits_for_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(RunError, match="no worker can be started"):
        list(shared_out(abs, [1, 2], 1))
