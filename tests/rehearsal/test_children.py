"""Processes of our own that end as nobody expects: whoever waits for them is told."""

import subprocess
import sys
import tempfile
from pathlib import Path
from queue import Queue

import pytest

from laglab.errors import RunError
from laglab.runs.processes.child import Child, Letter, _read
from laglab.runs.processes.reports import Ended
from laglab.studies.workers import shared_out

DYING = """\
import os, sys
sys.stdout.write('["Computed", "half of an')
sys.stdout.flush()
os.kill(os.getpid(), {signal})
"""


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
