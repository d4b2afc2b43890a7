"""Ctrl-C at any moment: one line, exit 130, and nothing is left: no process, folder or port."""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from laglab.scenario import load

from .traces import assert_whole, wait_for_rows

Start = Callable[..., "subprocess.Popen[str]"]
LONG = ("lab", "--duration", "3600")
COMMANDS = {
    "inline": ("run", *LONG, "--transport", "inline"),
    "udp": ("run", *LONG),
    "serial": ("run", *LONG, "--transport", "serial"),
    "gateway": ("gateway", *LONG, "--endpoint", "pty://port"),
    "controller": ("controller", *LONG, "--endpoint", "udpout://127.0.0.1:9"),
    "consistency": ("consistency", "lab", "--seeds", "1000"),
    "errata": ("errata", "fig8", "--seeds", "1000"),
    "soak": ("soak", "--minutes", "10"),
    "sweep": ("sweep", "gains", "--out", "study"),
    "bench": ("bench", "loop", "--rounds", "100"),
    "flood": ("bench", "flood", "--rounds", "100"),
    "conform": ("conform", "udpin://127.0.0.1:0", "--side", "robot"),
    "cable": ("serial", "port-1", "port-2"),
}
NEEDED = ("msgspec", "numpy", "pydantic_core")
"""Not those that others have Python load at its start, whatever program it runs."""
OBEYED_WITHIN = 20.0
"""[s] It may have to draw its results, beside others."""


class Started:
    """`laglab ARGUMENTS` in a process group of its own, as a shell starts it, and all that comes of
    it: whatever it starts has the same mark in its environment."""

    def __init__(self, arguments: tuple[str, ...], folder: Path) -> None:
        self._mark = uuid.uuid4().hex
        self._folder = folder
        self._temporary = Path(tempfile.mkdtemp(dir=folder))
        self.process = subprocess.Popen(
            [sys.executable, "-m", "laglab", *arguments],
            cwd=folder,
            env=os.environ | {"LAGLAB_TEST": self._mark, "TMPDIR": str(self._temporary)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def wait_until_it_loads(self) -> None:
        """Modules that we need: whatever comes before is Python's own start."""
        maps = Path(f"/proc/{self.process.pid}/maps")
        while not any(f"/{module}/" in maps.read_text() for module in NEEDED):
            time.sleep(0.002)

    def all_processes(self) -> list[int]:
        found = []
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                marked = self._mark.encode() in (folder / "environ").read_bytes()
            except OSError:
                continue  # it has just ended, or is somebody else's
            if marked:
                found.append(int(folder.name))
        return found

    def left_behind(self) -> list[str]:
        """Temporary files and ports."""
        ports = [path for path in self._folder.rglob("*") if path.is_symlink()]
        return [str(path) for path in [*self._temporary.iterdir(), *ports]]


@pytest.fixture
def started(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Started]:
    started = Started(COMMANDS[request.param], tmp_path)
    yield started
    for number in started.all_processes():
        with suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)
    started.process.communicate()


@pytest.mark.parametrize("started", COMMANDS, indirect=True)
@pytest.mark.parametrize("within", [(0.0, 0.4), (0.4, 2.5)], ids=["loading", "working"])
def test_ctrl_c(started: Started, within: tuple[float, float]) -> None:
    """At a random moment, to the whole group, as a terminal does it."""
    started.wait_until_it_loads()
    time.sleep(random.uniform(*within))
    os.killpg(started.process.pid, signal.SIGINT)
    _, errors = started.process.communicate(timeout=OBEYED_WITHIN)
    assert started.process.returncode == 130, errors
    *before, last = errors.splitlines()
    assert last == "laglab: interrupted", errors
    said = [line for line in before if "Traceback" in line or line.startswith("laglab:")]
    assert (said, started.all_processes(), started.left_behind()) == ([], [], []), errors


@pytest.mark.parametrize("started", ["udp", "consistency"], indirect=True)
def test_nothing_goes_on_when_we_are_killed(started: Started) -> None:
    deadline = time.monotonic() + 20
    while len(started.all_processes()) < 3:
        assert time.monotonic() < deadline
        time.sleep(0.02)
    time.sleep(random.uniform(0.0, 1.5))
    started.process.kill()
    _, errors = started.process.communicate(timeout=20)
    deadline = time.monotonic() + OBEYED_WITHIN
    while started.all_processes():
        assert time.monotonic() < deadline
        time.sleep(0.02)
    assert "Traceback" not in errors


@pytest.mark.parametrize("ignored", ["INT", "HUP"])
def test_what_we_were_started_to_ignore_stays_ignored(ignored: str, start_program: Start) -> None:
    """By `nohup`, or by a shell that starts us in the background."""
    script = f'trap "" {ignored}; exec "$@"'
    laglab = (sys.executable, "-m", "laglab", "gateway", "lab", "--endpoint", "udpin://127.0.0.1:0")
    process = start_program("sh", "-c", script, "sh", *laglab)
    assert process.stderr is not None
    assert process.stderr.readline().startswith("listening")
    process.send_signal(signal.Signals[f"SIG{ignored}"])
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(0.5)
    process.terminate()
    _, errors = process.communicate(timeout=10)
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "laglab: interrupted"


@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_a_run_without_end_lasts_until_ctrl_c_and_its_results_are_written(
    start: Start, tmp_path: Path, transport: str
) -> None:
    options = ("--duration", "inf", "--transport", transport, "--out", "run")
    run = start("run", "fig6", *options)
    wait_for_rows(tmp_path / "run" / "trace.csv")
    run.send_signal(signal.SIGINT)
    _, errors = run.communicate(timeout=20)
    assert run.returncode == 130
    assert "Traceback" not in errors
    assert_whole(tmp_path / "run" / "trace.csv")
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["verdict"].startswith("interrupted at tick")
    assert load(str(tmp_path / "run" / "scenario.toml")).last_tick is None


@pytest.mark.parametrize("out", [(), ("--out", "run")])
def test_a_run_that_had_not_begun_leaves_nothing_in_the_way(
    start: Start, tmp_path: Path, out: tuple[str, ...]
) -> None:
    """Of a gateway whose station never came, say."""
    waiting = ("gateway", "lab", "--endpoint", "udpin://127.0.0.1:0", *out)
    gateway = start(*waiting)
    assert "waiting for" in gateway.stderr.readline()
    place = tmp_path / ("run" if out else "runs/lab")
    while not (place / "scenario.toml").exists():
        time.sleep(0.01)
    gateway.send_signal(signal.SIGINT)
    gateway.communicate(timeout=20)
    assert gateway.returncode == 130
    assert not place.exists()


SLOW_LAW = """
from pathlib import Path
from time import sleep

class Law:
    def __init__(self, goal): pass
    def drive(self, pose, time, memory):
        if time > 0.5:
            Path("busy").touch()
            sleep(1.5)
        return 0.1, 0.0, memory
"""


def test_a_side_that_is_busy_has_time_for_its_last_words(start: Start, tmp_path: Path) -> None:
    (tmp_path / "slow.py").write_text(SLOW_LAW)
    run = start("run", *LONG, "--law", "slow:Law", "--out", "run")
    while not (tmp_path / "busy").exists():
        assert run.poll() is None
        time.sleep(0.01)
    run.send_signal(signal.SIGINT)
    _, errors = run.communicate(timeout=30)
    assert run.returncode == 130, errors
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["verdict"].startswith("interrupted at tick")
    assert summary["station"] is not None


def test_the_two_sides_of_a_run_without_end_meet_too(
    start: Start, listening_port: Callable[["subprocess.Popen[str]"], str], tmp_path: Path
) -> None:
    options = ("fig6", "--duration", "inf")
    gateway = start("gateway", *options, "--endpoint", "udpin://127.0.0.1:0", "--out", "run")
    link = ("--endpoint", f"udpout://127.0.0.1:{listening_port(gateway)}")
    station = start("controller", *options, *link)
    wait_for_rows(tmp_path / "run" / "trace.csv")
    gateway.send_signal(signal.SIGINT)
    assert gateway.wait(30) == station.wait(10) == 130


def test_an_interrupt_that_meets_a_string_is_no_other(tmp_path: Path) -> None:
    """Where a dataclass is made, say: Python would end itself by the signal, whatever we return."""
    (tmp_path / "eager.py").write_text('exec("raise KeyboardInterrupt")\n')
    laglab = (sys.executable, "-m", "laglab", "run", "fig6", "--estimator", "eager:Filter")
    ended = subprocess.run(laglab, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (130, "laglab: interrupted\n")


INTERRUPTING = """import os
import signal
from pathlib import Path

from laglab_control import Ekf

class Filter(Ekf):
    def predict(self, state, u):
        for number in range({times}):
            if Path("run/trace.csv").exists() and not Path(f"sent-{{number}}").exists():
                Path(f"sent-{{number}}").touch()
                os.kill(os.getpid(), signal.SIGTERM)
        return super().predict(state, u)
"""


@pytest.mark.parametrize("times", [1, 2])
def test_results_that_are_being_written_are_finished_unless_it_comes_twice(
    start: Start, tmp_path: Path, times: int
) -> None:
    """A filter beside the loop is run when that is over, in the process that is told to end."""
    (tmp_path / "eager.py").write_text(INTERRUPTING.format(times=times))
    compared = ("--estimator", "delayed-ekf", "--estimator", "eager:Filter")
    run = start("run", "fig6", "--duration", "1", *compared, "--out", "run")
    output, errors = run.communicate(timeout=30)
    assert (run.returncode, errors.splitlines()[-1]) == (130, "laglab: interrupted")
    assert ("results in run" in output) == (times == 1)
    assert (tmp_path / "run" / "summary.json").exists() == (times == 1)


WAITING = """from pathlib import Path
from time import sleep

from laglab_control import Ekf

class Filter(Ekf):
    def start(self, x, P):
        while not Path("sent").exists() and Path("heard/trace.csv").exists():
            sleep(0.01)
        return super().start(x, P)
"""


@pytest.mark.slow
def test_a_station_whose_run_is_over_writes_its_tables_first(
    start: Start, listening_port: Callable[["subprocess.Popen[str]"], str], tmp_path: Path
) -> None:
    """From what it heard, when that is all: which took seconds, and was cut short."""
    (tmp_path / "waiting.py").write_text(WAITING)
    options = ("fig6", "--duration", "40")
    gateway = start("gateway", *options, "--endpoint", "udpin://127.0.0.1:0", "--out", "run")
    link = ("--endpoint", f"udpout://127.0.0.1:{listening_port(gateway)}")
    beside = ("--estimator", "popf", "--estimator", "waiting:Filter")
    station = start("controller", *options, *link, *beside, "--out", "heard")
    wait_for_rows(tmp_path / "heard" / "trace.csv")
    station.send_signal(signal.SIGTERM)
    (tmp_path / "sent").touch()
    _, errors = station.communicate(timeout=30)
    assert (station.returncode, gateway.wait(30)) == (130, 0)
    assert "finishing what is begun; one more interrupt leaves it undone" in errors
    summary = json.loads((tmp_path / "heard" / "summary.json").read_text())
    assert (summary["outcome"], summary["ticks"]) == ("completed", 4000)
    assert_whole(tmp_path / "heard" / "trace.csv")
