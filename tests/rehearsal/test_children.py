"""Processes of our own that end as nobody expects: whoever waits for them is told."""

import os
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from queue import Queue

import pytest

from laglab.errors import RunError
from laglab.interrupts import INTERRUPTED
from laglab.runs.processes.child import HEEDED_WITHIN, Child, Letter, _read
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


SWALLOWING = """\
import time
from queue import Queue
from laglab.runs.processes.child import Tell, started
from laglab.runs.processes.reports import Listening, Order

def swallow(order: Order, tell: Tell) -> None:
    tell(Listening(""))
    for _ in range(600):
        try:
            time.sleep(0.1)
        except:
            pass

if __name__ == "__main__":
    inbox = Queue()
    with started("swallowing", "swallowing:swallow", Order("", ""), inbox):
        print(inbox.get().report, flush=True)
        inbox.get()
"""


@pytest.mark.slow
def test_who_swallows_interrupts_does_not_outlive_a_parent_that_is_killed(tmp_path: Path) -> None:
    (tmp_path / "swallowing.py").write_text(SWALLOWING)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    told = os.environ | {"PYTHONPATH": str(tmp_path), "TMPDIR": str(temporary)}
    command = [sys.executable, "-m", "swallowing"]
    with subprocess.Popen(command, env=told, stdout=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        assert parent.stdout.readline().startswith(b"Listening")
        parent.kill()
    deadline = time.monotonic() + 2 * HEEDED_WITHIN
    while any(temporary.iterdir()):
        assert time.monotonic() < deadline
        time.sleep(0.1)


INTERRUPTED_AT_ITS_END = """\
import signal, sys
from laglab.runs.processes.child import _leave

def interrupt(frame, event, _):
    if frame.f_code.co_name == "on_interrupt":
        sys.setprofile(None)
        signal.raise_signal(signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.setprofile(interrupt)
_leave()
"""


def test_one_that_leaves_is_not_interrupted_any_more(tmp_path: Path) -> None:
    """A parent that is killed is found gone twice: by who tells it something and who listens."""
    command = [sys.executable, "-c", INTERRUPTED_AT_ITS_END, "", "", str(tmp_path / "temporary")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (INTERRUPTED, "")


def test_where_no_worker_can_be_started_nobody_waits_for_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "gone"))
    with pytest.raises(RunError, match="no worker can be started"):
        list(shared_out(abs, [1, 2], 1))
