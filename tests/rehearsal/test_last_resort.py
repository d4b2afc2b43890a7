"""A process that heeds no signal is ended; one that does is not, whatever else it hears."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import laglab

BEGUN = """
import ctypes, os, signal, time
import laglab.last_resort as last_resort

last_resort.UNHEARD = 1.0
me, until = os.getpid(), time.monotonic() + 3.0


def busy():
    while time.monotonic() < until:
        pass


def tell(*signals):
    if os.fork() == 0:
        time.sleep(0.3)
        for each in signals:
            os.kill(me, each)
            time.sleep(0.001)
        os._exit(0)


with last_resort.never_in_vain(lambda *_: None):
"""
HEEDING = {
    "two signals, one right behind the other": "tell(signal.SIGTERM, signal.SIGHUP); busy()",
    "the same signal twice": "tell(signal.SIGTERM, signal.SIGTERM); busy()",
    "a timer of somebody's": """
    signal.signal(signal.SIGALRM, lambda *_: None)
    signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)
    busy()
    signal.setitimer(signal.ITIMER_REAL, 0.0)""",
    "a child of somebody's is told to end": """
    child = os.fork()
    if child == 0:
        time.sleep(30.0)
    time.sleep(0.3)
    os.kill(child, signal.SIGTERM)
    busy()
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)""",
}
DEAF = """
    tell(signal.SIGTERM)
    lock = ctypes.create_string_buffer(256)
    library = ctypes.CDLL(None)
    library.pthread_mutex_lock(lock)
    library.pthread_mutex_lock(lock)"""
"""What waits for itself hears nothing, as an endless loop in C does."""


def ended(then: str) -> "subprocess.CompletedProcess[str]":
    script = f"{BEGUN}    {then.strip()}\nprint('went on')\n"
    quietly = ("-W", "ignore:This process:DeprecationWarning")  # Python 3.12 warns of every fork
    return subprocess.run(
        [sys.executable, *quietly, "-c", script],
        capture_output=True,
        text=True,
        timeout=50,
        check=False,
    )


@pytest.mark.skipif(not hasattr(os, "fork"), reason="signals as POSIX has them")
@pytest.mark.slow
@pytest.mark.parametrize("then", HEEDING.values(), ids=HEEDING)
def test_who_heeds_signals_goes_on(then: str) -> None:
    done = ended(then)
    assert (done.returncode, done.stdout, done.stderr) == (0, "went on\n", "")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="a lock that waits for itself")
def test_who_heeds_none_is_ended() -> None:
    done = ended(DEAF)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "laglab: interrupted\n")


NAMING = """
class Named:
    def __set_name__(self, owner, name):
        raise KeyboardInterrupt

class Axes:
    named = Named()
"""


def test_an_interrupt_that_meets_a_class_in_the_making_is_no_other(tmp_path: Path) -> None:
    """A library's, as it is loaded: Python 3.11 makes a RuntimeError of it."""
    laglab.run("lab", {"duration": 0.1}, out=tmp_path / "run")
    (tmp_path / "matplotlib").mkdir()
    (tmp_path / "matplotlib" / "__init__.py").write_text(NAMING)
    command = (sys.executable, "-m", "laglab", "figure", "run")
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (130, "laglab: interrupted\n")
