"""Whatever goes wrong in a filter or a law that somebody brought: one line, and a whole record."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from threading import Event

import pytest

from laglab.runs import rehearse
from laglab.runs.waiting import in_time
from laglab.runs.whole import run_into
from laglab.scenario import load
from laglab_control import PluginError
from laglab_gateway import MemoryRecorder

Laglab = Callable[..., "subprocess.CompletedProcess[str]"]
Ended = Callable[..., tuple[int, str, str]]
Refused = Callable[..., str]

pytestmark = pytest.mark.timeout(120)

LAB = ("run", "lab", "--duration", "2", "--set", "estimator.guard=false", "--out", "run")
INLINE = ("--transport", "inline")

FAILING = [
    ("--estimator", "Failing", "tick 40: mine:Failing.correct: ValueError: something is wrong"),
    ("--estimator", "FailingAhead", "tick 41: mine:FailingAhead.predict: KeyError: 40"),
    ("--estimator", "Leaving", "tick 0: mine:Leaving.correct: SystemExit: I am off"),
    ("--law", "NanLaw", "tick 40: mine:NanLaw.drive: must answer finite speeds"),
]
"""In each place where it is called."""
ANSWERS = {
    "estimator:Nan": "Nan.correct must answer a finite array x (d,), not",
    "estimator:Complex": "Complex.correct must answer a finite array x (d,), not",
    "estimator:Objects": "Objects.correct must answer a finite array x (d,), not",
    "estimator:Short": "Short.correct must answer a state with tick, x and P: ",
    "estimator:NoState": "NoState.correct must answer a state with tick, x and P, not array([",
    "estimator:LooksItUp": "LooksItUp.correct must answer a state with tick, x and P: KeyError",
    "estimator:Text": "Text.correct must answer a state with tick, x and P: ",
    "estimator:NanClaim": "NanClaim.correct must answer a finite P (5, 5) or",
    "estimator:Unspeakable": "Unspeakable.correct: Silent",
    "estimator:Closing": "Closing.correct: GeneratorExit",
    "estimator:Ragged": "Ragged.ahead must answer a finite pose (3,), not [[1",
    "law:FailingLaw": "FailingLaw.drive: ZeroDivisionError",
    "law:TwoNumbers": "TwoNumbers.drive: must answer v, omega and a mem",
    "law:HugeLaw": "HugeLaw.drive: must answer v, omega and a memory, not (1000",
    "law:TextLaw": "TextLaw.drive: must answer v, omega and a memory, not ('0.1'",
}


def rows(folder: Path) -> int:
    return len((folder / "run" / "trace.csv").read_text().splitlines()) - 1


def failed_as_it_must(folder: Path, code: int, stderr: str, said: str) -> None:
    assert code == 4, stderr
    (line,) = (line for line in stderr.splitlines() if line.startswith("laglab:"))
    assert said in line
    assert "Traceback" not in stderr
    tick = int(said.split()[1].strip(":"))
    assert tick + 1 <= rows(folder) <= tick + 2
    summary = json.loads((folder / "run" / "summary.json").read_text())
    assert said.split(": ")[1][:12] in summary["verdict"]


@pytest.mark.parametrize(("kind", "name", "said"), FAILING)
def test_what_fails_under_way_ends_both_processes_in_one_line_and_keeps_the_record(
    ended_here: Ended, brought: Path, kind: str, name: str, said: str
) -> None:
    code, _, stderr = ended_here(*LAB, kind, f"mine:{name}")
    failed_as_it_must(brought, code, stderr, said)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Asking", "tick 40: mine:Asking.correct: EOFError: EOF when reading a line (mine.py, lin"),
        ("Debugged", "tick 40: mine:Debugged.correct: BdbQuit (mine.py, line"),
    ],
)
def test_in_a_process_of_its_own_nobody_is_there_to_be_asked(
    ended_here: Ended, brought: Path, name: str, said: str
) -> None:
    """It is ours from which the orders come, so what waited for an answer waited for good."""
    code, _, stderr = ended_here(*LAB, "--estimator", f"mine:{name}", "--silence", "5")
    failed_as_it_must(brought, code, stderr, said)


MARKUP = (
    "--estimator",
    "Markup",
    "tick 40: mine:Markup.correct: ValueError: [/nope] see [bold] :cat:",
)


@pytest.mark.parametrize(("kind", "name", "said"), [*FAILING[2:], MARKUP])
def test_inline_it_is_no_different(
    brought: Path, ended: Ended, kind: str, name: str, said: str
) -> None:
    code, _, stderr = ended(*LAB, kind, f"mine:{name}", *INLINE)
    failed_as_it_must(brought, code, stderr, said)
    assert ("(mine.py, line " in stderr) == (name != "NanLaw"), "where it was raised, if it was"


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("what", ANSWERS)
def test_whatever_it_answers_at_tick_40_is_told(what: str) -> None:
    kind, name = what.split(":")
    told = {f"{kind}.kind": f"mine:{name}", "estimator.guard": False}
    recorder = MemoryRecorder()
    ending = rehearse.rehearse_inline(load("lab", told), recorder, lambda *_: None)
    assert ending.exit_code == 4
    assert ending.problem.startswith(f"tick 40: mine:{ANSWERS[what]}")
    assert 41 <= len(recorder.rows) <= 42


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_where_the_robot_fails_both_sides_have_their_say(
    tmp_path: Path, transport: rehearse.Transport
) -> None:
    """And what both warn of is told once."""
    told = {"plant.kind": "broken:Halting", "safety.v_limit": 0.01, "duration": 2.0}
    ending = run_into(tmp_path / "run", load("lab", told), transport, rehearse.unheard)
    assert "the motor burnt" in ending.problem
    assert ending.station is not None
    assert ending.link is not None
    assert ending.link.measurement.arrived == 0 < ending.link.command.arrived
    assert ending.loop_seconds > 0
    warned = [text for text in ending.warnings if "told different things" in text]
    assert len(warned) == 1


@pytest.mark.usefixtures("brought")
@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_where_the_station_fails_both_sides_have_their_say(
    tmp_path: Path, transport: rehearse.Transport
) -> None:
    told = {"law.kind": "mine:FailingLaw", "duration": 2.0}
    ending = run_into(tmp_path / "run", load("lab", told), transport, rehearse.unheard)
    assert "ZeroDivisionError" in ending.problem
    assert ending.station is not None
    assert ending.link is not None


def test_where_the_station_cannot_begin_the_robot_is_not_blamed(
    brought: Path, ended: Ended
) -> None:
    code, _, errors = ended(*LAB, "--estimator", "mine:AtHome", "--transport", "udp")
    assert code == 2, errors
    assert errors.startswith("laglab: mine:AtHome cannot be made: RuntimeError: there is no lic")
    assert "robot" not in errors
    assert not (brought / "run").exists()


def test_a_guard_lets_no_such_state_pass(brought: Path, ended: Ended) -> None:
    own = ("--estimator", "mine:Guarded", "--set", "estimator.guard=true")
    code, _, stderr = ended(*LAB, *own, *INLINE)
    said = "tick 6: mine:Guarded.predict must answer a finite array x"
    failed_as_it_must(brought, code, stderr, said)


@pytest.mark.slow
def test_one_that_never_answers_is_given_up_and_its_process_is_ended(
    laglab: Laglab, brought: Path
) -> None:
    failed = laglab(*LAB, "--estimator", "mine:Sleeping", "--silence", "1")
    assert failed.returncode == 4
    (line,) = (line for line in failed.stderr.splitlines() if line.startswith("laglab:"))
    assert "silent" in line
    assert 40 <= rows(brought) <= 41


def test_a_comparison_that_fails_costs_the_run_nothing(brought: Path, ended: Ended) -> None:
    compared = ("--estimator", "delayed-ekf", "--estimator", "mine:Failing")
    code, _, stderr = ended(*LAB, *compared, *INLINE)
    assert code == 0, stderr
    assert "warning: tick 40: mine:Failing.correct: ValueError" in stderr
    shadow = (brought / "run" / "shadow-mine%3AFailing.csv").read_text().splitlines()
    assert len(shadow) == 1 + 40


@pytest.mark.parametrize(
    ("kind", "name", "said"),
    [
        ("--estimator", "mine:NoMethod", "mine:NoMethod has no method correct(state, measure"),
        ("--estimator", "mine:WrongSignature", "mine:WrongSignature.correct must be correct(st"),
        ("--estimator", "mine:NoModel", "mine:NoModel cannot be made: TypeError"),
        ("--estimator", "mine:Nobody", "mine:Nobody: AttributeError"),
        ("--estimator", "nowhere:Nobody", "nowhere:Nobody: ModuleNotFoundError"),
        ("--estimator", "mine.py:Wide", "name the module, mine:Wide"),
        ("--estimator", "mine:np", "mine:np: mine:np is no class"),
        ("--estimator", "nobody", "must be one of raw, ekf"),
        ("--law", "mine:NoDrive", "mine:NoDrive has no method drive(pose, time, memory)"),
        ("--law", "mine:Nobody", "mine:Nobody: AttributeError"),
    ],
)
def test_what_cannot_be_had_is_one_line_before_anything_runs(
    brought: Path, refused: Refused, kind: str, name: str, said: str
) -> None:
    assert said in refused(*LAB, kind, name)
    assert not (brought / "run").exists()


def test_what_is_never_made_is_given_up() -> None:
    never = Event()
    with pytest.raises(PluginError, match=r"mine:Slow does not come back: 0\.05 s were not enough"):
        in_time("mine:Slow", lambda: never.wait(60), seconds=0.05)
    never.set()
    with pytest.raises(ZeroDivisionError):
        in_time("mine:Slow", lambda: 1 / 0)


def test_a_side_that_does_not_start_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rehearse, "START", -1.0)
    ending = rehearse.rehearse_apart(load("lab", {}), "udp", tmp_path)
    assert ending.problem == "the robot's side did not start within -1 s: robot"
    assert ending.exit_code == 2
