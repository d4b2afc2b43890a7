"""Filters and laws that somebody brought: in every process, and whatever goes wrong in them."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from threading import Event

import numpy as np
import pytest

from laglab.command import main
from laglab.runs import rehearse
from laglab.runs.station_side import check_parts
from laglab.runs.waiting import in_time
from laglab.scenario import load
from laglab.studies.sweep.study import Study
from laglab_control import PluginError

Laglab = Callable[..., "subprocess.CompletedProcess[str]"]

MINE = '''
"""What a user wrote."""
import time
from typing import NamedTuple
import numpy as np
from laglab_control import DelayedEkf, RigidMotions, PolarLaw


class State(NamedTuple):
    inner: object
    x: object
    P: object
    tick: int


class Wide:
    """Five states, of which two are of no use."""

    def __init__(self, model, spare=2):
        self.ekf, self.spare = DelayedEkf(model, RigidMotions(model)), spare

    def _of(self, inner):
        P = np.eye(3 + self.spare)
        P[:3, :3] = inner.P
        return State(inner, np.append(inner.x, np.ones(self.spare)), P, inner.tick)

    def start(self, x, P):
        return self._of(self.ekf.start(x, P))

    def predict(self, state, u):
        return self._of(self.ekf.predict(state.inner, u))

    def correct(self, state, measurements, inputs=()):
        return self._of(self.ekf.correct(state.inner, measurements, inputs))


class Watchable(Wide):
    def innovation(self, state):
        return self.ekf.innovation(state.inner)


class Foreseeing(Wide):
    """Says itself where the robot will be."""

    def __init__(self, model):
        super().__init__(model)
        self.model = model

    def ahead(self, state, inputs):
        x = state.x[:3]
        for u in inputs:
            x = self.model.f(x, u)
        return x


class Nan(Wide):
    def correct(self, state, measurements, inputs=()):
        corrected = super().correct(state, measurements, inputs)
        return corrected._replace(x=corrected.x * np.nan) if state.tick == 40 else corrected


class Failing(Wide):
    def correct(self, state, measurements, inputs=()):
        if state.tick == 40:
            raise ValueError("something is\\nwrong")
        return super().correct(state, measurements, inputs)


class FailingAhead(Wide):
    def predict(self, state, u):
        return {}[state.tick] if state.tick == 40 else super().predict(state, u)


class Short(Wide):
    def correct(self, state, measurements, inputs=()):
        corrected = super().correct(state, measurements, inputs)
        return corrected._replace(x=corrected.x[:2]) if state.tick == 40 else corrected


class NoState(Wide):
    def correct(self, state, measurements, inputs=()):
        return state.x if state.tick == 40 else super().correct(state, measurements, inputs)


class Sleeping(Wide):
    def correct(self, state, measurements, inputs=()):
        if state.tick == 40:
            time.sleep(3600)
        return super().correct(state, measurements, inputs)


class Leaving(Wide):
    def correct(self, state, measurements, inputs=()):
        raise SystemExit("I am off")


class At40(Wide):
    """Answers something else then."""

    def correct(self, state, measurements, inputs=()):
        right = super().correct(state, measurements, inputs)
        return self.other(right) if state.tick == 40 else right


class Complex(At40):
    def other(self, right):
        return right._replace(x=right.x + 0j)


class Objects(At40):
    def other(self, right):
        return right._replace(x=np.array([None, 1, 2, 3, 4]))


class Text(At40):
    def other(self, right):
        return right._replace(x="x")


class NanClaim(At40):
    def other(self, right):
        return right._replace(P=right.P * np.nan)


class Markup(At40):
    def other(self, right):
        raise ValueError("[/nope] see [bold] :cat:")


class Guarded(Watchable):
    """Nothing has come yet, so nothing is corrected."""

    def predict(self, state, u):
        right = super().predict(state, u)
        return right._replace(x=right.x + 0j) if state.tick == 5 else right


class Silent(Exception):
    def __str__(self):
        raise RuntimeError


class Unspeakable(At40):
    def other(self, right):
        raise Silent


class Closing(At40):
    def other(self, right):
        raise GeneratorExit


class Ragged(Wide):
    def ahead(self, state, inputs):
        return [[1, 2], 3] if state.tick == 40 else None


class NoMethod:
    def __init__(self, model):
        self.start = self.predict = lambda a, b: None


class WrongSignature(Wide):
    def correct(self, state):
        return state


class NoModel:
    pass


class Law:
    """The paper's, by another name."""

    def __init__(self, goal, gain=3.0):
        self.law = PolarLaw(goal, gamma=gain, goal_tolerance=0.03)

    def drive(self, pose, time, memory):
        v, omega, memory = self.law.drive(pose, time, memory)
        return v, omega, memory


class NanLaw(Law):
    def drive(self, pose, time, memory):
        return (float("nan"), 0.0, None) if time > 0.495 else super().drive(pose, time, memory)


class FailingLaw(Law):
    def drive(self, pose, time, memory):
        return 1 / 0 if time > 0.495 else super().drive(pose, time, memory)


class TwoNumbers(Law):
    def drive(self, pose, time, memory):
        return (0.0, 0.0) if time > 0.495 else super().drive(pose, time, memory)


class NoDrive:
    def __init__(self, goal):
        pass
'''


pytestmark = pytest.mark.timeout(120)


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """The folder in which the command is run."""
    (tmp_path / "mine.py").write_text(MINE)
    return tmp_path


def trace(folder: Path) -> str:
    return (folder / "trace.csv").read_text()


LAB = ("run", "lab", "--duration", "2", "--set", "estimator.guard=false", "--out", "run", "--force")


def test_a_filter_and_a_law_of_ones_own_are_as_good_as_ours(laglab: Laglab, mine: Path) -> None:
    ours = laglab(*LAB[:-3], "--transport", "inline", "--out", "ours")
    assert ours.returncode == 0, ours.stderr
    own = ("--estimator", "mine:Wide", "--estimator", "mine:Foreseeing", "--law", "mine:Law")
    done = laglab(*LAB, *own, "--transport", "udp")
    assert done.returncode == 0, done.stderr
    assert trace(mine / "run") == trace(mine / "ours")
    assert (mine / "run" / "shadow-mine%3AForeseeing.csv").exists()
    summary = json.loads((mine / "run" / "summary.json").read_text())
    assert summary["compare"]["mine:Foreseeing"] == summary["compare"]["mine:Wide"]
    assert (summary["estimator"], summary["law"]) == ("mine:Wide", "mine:Law")


@pytest.mark.usefixtures("mine")
def test_options_reach_the_class(laglab: Laglab) -> None:
    options = (
        "--estimator", "mine:Wide", "--set", "estimator.options={spare=5}",
        "--law", "mine:Law", "--set", "law.options.gain=1.0", "--transport", "inline",
    )  # fmt: skip
    assert laglab(*LAB, *options).returncode == 0
    refused = laglab(*LAB, *options, "--set", "estimator.options.wings=2")
    assert refused.returncode == 2
    (line,) = refused.stderr.strip().splitlines()
    assert "mine:Wide cannot be made: TypeError" in line
    assert "wings" in line


def test_what_says_where_the_robot_will_be_is_believed(laglab: Laglab, mine: Path) -> None:
    for name in ("Wide", "Foreseeing"):
        done = laglab(
            *LAB[:-3], "--estimator", f"mine:{name}", "--transport", "inline", "--out", name
        )
        assert done.returncode == 0, done.stderr
    sent = [np.genfromtxt(mine / name / "trace.csv", delimiter=",", names=True)["v_sent"]
            for name in ("Wide", "Foreseeing")]  # fmt: skip
    assert sent[0] == pytest.approx(sent[1], abs=1e-9)


@pytest.mark.usefixtures("mine")
def test_a_guard_needs_to_see_how_wild_a_measurement_is(laglab: Laglab) -> None:
    guarded = ("run", "lab", "--duration", "1", "--out", "run", "--force", "--transport", "inline")
    assert laglab(*guarded, "--estimator", "mine:Watchable").returncode == 0
    refused = laglab(*guarded, "--estimator", "mine:Wide")
    assert refused.returncode == 2
    assert "estimator.guard: mine:Wide has no method innovation(state)" in refused.stderr


FAILING = [
    ("--estimator", "Nan", "tick 40: mine:Nan.correct must answer a finite array x"),
    ("--estimator", "Failing", "tick 40: mine:Failing.correct: ValueError: something is wrong"),
    ("--estimator", "FailingAhead", "tick 41: mine:FailingAhead.predict: KeyError: 40"),
    ("--estimator", "Short", "tick 40: mine:Short.correct must answer a state with tick"),
    ("--estimator", "NoState", "tick 40: mine:NoState.correct must answer a state with tick"),
    ("--estimator", "Leaving", "tick 0: mine:Leaving.correct: SystemExit: I am off"),
    ("--law", "NanLaw", "tick 40: mine:NanLaw.drive: must answer finite speeds"),
    ("--law", "FailingLaw", "tick 40: mine:FailingLaw.drive: ZeroDivisionError"),
    ("--law", "TwoNumbers", "tick 40: mine:TwoNumbers.drive: must answer v, omega and a mem"),
]


def failed_as_it_must(folder: Path, code: int, stderr: str, said: str) -> None:
    assert code == 4, stderr
    lines = [line for line in stderr.splitlines() if line.startswith("laglab:")]
    assert len(lines) == 1
    assert said in lines[0]
    assert "Traceback" not in stderr
    tick = int(said.split()[1].strip(":"))
    assert tick + 1 <= len(trace(folder).splitlines()) - 1 <= tick + 2
    summary = json.loads((folder / "summary.json").read_text())
    assert said.split(": ")[1][:12] in summary["verdict"]


@pytest.mark.parametrize(
    ("kind", "name", "said"),
    [
        pytest.param(*each, marks=[pytest.mark.slow] if each[1] in ("Short", "NoState") else [])
        for each in FAILING
    ],
)
def test_what_fails_under_way_ends_both_processes_in_one_line_and_keeps_the_record(
    laglab: Laglab, mine: Path, kind: str, name: str, said: str
) -> None:
    failed = laglab(*LAB, kind, f"mine:{name}")
    failed_as_it_must(mine / "run", failed.returncode, failed.stderr, said)


@pytest.mark.slow
def test_one_that_never_answers_is_given_up_and_its_process_is_ended(
    laglab: Laglab, mine: Path
) -> None:
    failed = laglab(*LAB, "--estimator", "mine:Sleeping", "--silence", "1")
    assert failed.returncode == 4
    (line,) = (line for line in failed.stderr.splitlines() if line.startswith("laglab:"))
    assert "silent" in line
    assert 40 <= len(trace(mine / "run").splitlines()) - 1 <= 41


def in_this_process(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str]:
    """Exit code and standard error."""
    with pytest.raises(SystemExit) as ended:
        main([*arguments])
    assert isinstance(ended.value.code, int)
    return ended.value.code, capsys.readouterr().err


STRANGE = [
    (
        "--estimator",
        "Complex",
        "tick 40: mine:Complex.correct must answer a finite array x (d,), not",
    ),
    (
        "--estimator",
        "Objects",
        "tick 40: mine:Objects.correct must answer a finite array x (d,), not",
    ),
    ("--estimator", "Text", "tick 40: mine:Text.correct must answer a state with tick, x and P: "),
    ("--estimator", "NanClaim", "tick 40: mine:NanClaim.correct must answer a finite P (5, 5) or"),
    ("--estimator", "Markup", "tick 40: mine:Markup.correct: ValueError: [/nope] see [bold] :cat:"),
    ("--estimator", "Unspeakable", "tick 40: mine:Unspeakable.correct: Silent"),
    ("--estimator", "Closing", "tick 40: mine:Closing.correct: GeneratorExit"),
    ("--estimator", "Ragged", "tick 40: mine:Ragged.ahead must answer a finite pose (3,), not [[1"),
]
"""What nobody would expect; it is the same in two processes."""


@pytest.mark.parametrize(("kind", "name", "said"), FAILING + STRANGE)
def test_inline_it_is_no_different(
    mine: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    kind: str,
    name: str,
    said: str,
) -> None:
    monkeypatch.chdir(mine)
    code, stderr = in_this_process(capsys, *LAB, kind, f"mine:{name}", "--transport", "inline")
    failed_as_it_must(mine / "run", code, stderr, said)


@pytest.mark.parametrize(
    ("kind", "name", "said"),
    [
        ("--estimator", "mine:NoMethod", "mine:NoMethod has no method correct(state, measure"),
        ("--estimator", "mine:WrongSignature", "mine:WrongSignature.correct must be correct(st"),
        ("--estimator", "mine:NoModel", "mine:NoModel cannot be made: TypeError"),
        ("--estimator", "mine:Nobody", "mine:Nobody: AttributeError"),
        ("--estimator", "nowhere:Nobody", "nowhere:Nobody: ModuleNotFoundError"),
        ("--estimator", "mine:np", "mine:np: mine:np is no class"),
        ("--estimator", "nobody", "must be one of raw, ekf"),
        ("--law", "mine:NoDrive", "mine:NoDrive has no method drive(pose, time, memory)"),
        ("--law", "mine:Nobody", "mine:Nobody: AttributeError"),
    ],
)
def test_what_cannot_be_had_is_one_line_before_anything_runs(
    mine: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    kind: str,
    name: str,
    said: str,
) -> None:
    monkeypatch.chdir(mine)
    code, stderr = in_this_process(capsys, *LAB, kind, name)
    assert code == 2
    (line,) = stderr.strip().splitlines()
    assert line.startswith("laglab:")
    assert said in line
    assert not (mine / "run").exists()


def test_who_runs_it_as_a_script_has_the_current_directory_too(mine: Path) -> None:
    """The search path of an installed command begins where the command lies."""
    command = Path(sys.executable).with_name("laglab")
    done = subprocess.run(
        [command, *LAB, "--estimator", "mine:Wide", "--transport", "inline", "--duration", "0.1"],
        cwd=mine,
        check=False,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("key", ["estimator.kind", "law.kind"])
def test_a_studys_cells_are_others_when_the_module_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, key: str
) -> None:
    monkeypatch.chdir(tmp_path)
    origins = []
    for text in ("", "# changed\n"):
        (tmp_path / "own_parts.py").write_text(MINE + text)
        study = Study(load("lab", {key: "own_parts:Wide"}), range(1, 3))
        origins.append(study.origin)
    assert origins[0] != origins[1]


def test_a_comparison_that_fails_costs_the_run_nothing(laglab: Laglab, mine: Path) -> None:
    compared = ("--estimator", "delayed-ekf", "--estimator", "mine:Failing")
    done = laglab(*LAB, *compared, "--transport", "inline")
    assert done.returncode == 0, done.stderr
    assert "warning: tick 40: mine:Failing.correct: ValueError" in done.stderr
    rows = (mine / "run" / "shadow-mine%3AFailing.csv").read_text().splitlines()
    assert len(rows) == 1 + 40


@pytest.mark.slow
def test_they_are_replayed_judged_and_studied(laglab: Laglab, mine: Path) -> None:
    short = ("--transport", "inline", "--out", "run")
    assert laglab("run", "lab", "--duration", "1", *short).returncode == 0
    replayed = laglab("replay", "run/robot.tlog", "--estimator", "mine:Wide", "--out", "again")
    assert replayed.returncode == 0, replayed.stderr
    assert (mine / "again" / "mine%3AWide.csv").exists()
    failed = laglab("replay", "run/robot.tlog", "--estimator", "mine:Failing", "--out", "again")
    assert failed.returncode == 4
    assert "laglab: tick 40: mine:Failing.correct" in failed.stderr
    judged = laglab(
        "consistency", "lab", "--duration", "1", "--seeds", "2", "--judge", "mine:Wide",
        "--judge", "delayed-ekf", "--workers", "1",
    )  # fmt: skip
    assert judged.returncode == 0, judged.stderr
    assert "mine:Wide" in judged.stdout


@pytest.mark.slow
def test_stations_with_them_are_tried_and_studies_run_them_one_by_one(
    laglab: Laglab, mine: Path
) -> None:
    tried = laglab(
        "trust", "--only", "lab", "--seeds", "1", "--workers", "1", "--estimator", "mine:Watchable"
    )
    assert tried.returncode == 0, tried.stderr
    (mine / "study.toml").write_text(
        'scenario = "lab"\nseeds = 2\n'
        '[grid]\n"estimator.kind" = ["mine:Watchable", "delayed-ekf"]\n'
    )
    studied = laglab("sweep", "study.toml", "--set", "duration=1.0", "--workers", "1")
    assert studied.returncode == 0, studied.stderr
    assert "there is no mine:Watchable for many robots" in studied.stdout + studied.stderr


def test_two_machines_of_which_only_the_station_has_it(
    start: Callable[..., "subprocess.Popen[str]"],
    listening_port: Callable[["subprocess.Popen[str]"], str],
    tmp_path: Path,
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    own = ("--estimator", "mine:Wide", "--set", "estimator.guard=false", "--duration", "1")
    gateway = start("gateway", "lab", *own, "--endpoint", "udpin://127.0.0.1:0", "--out", "robot")
    port = listening_port(gateway)
    (tmp_path / "mine.py").write_text(MINE)  # the robot's side began without it
    station = start(
        "controller", "lab", *own, "--endpoint", f"udpout://127.0.0.1:{port}", "--out", "station"
    )
    for side in (station, gateway):
        _, errors = side.communicate(timeout=60)
        assert side.returncode == 0, errors


def test_a_guard_lets_no_such_state_pass(
    mine: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(mine)
    own = ("--estimator", "mine:Guarded", "--set", "estimator.guard=true")
    code, stderr = in_this_process(capsys, *LAB, *own, "--transport", "inline")
    failed_as_it_must(
        mine / "run", code, stderr, "tick 6: mine:Guarded.predict must answer a finite array x"
    )


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


def test_a_filter_that_shadows_itself_keeps_its_options(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "needy.py").write_text(
        "from laglab_control import Backdated\n\n\n"
        "class Needy(Backdated):\n"
        "    def __init__(self, model, needed):\n        super().__init__(model)\n\n"
        "    def forward(self, x, P, u):\n        return self.model.predict(x, P, u)\n\n"
        "    def corrected(self, x, P, z):\n        return x, P\n"
    )
    told = {"estimator.kind": "needy:Needy", "estimator.options": {"needed": 1}}
    check_parts(load("lab", told | {"estimator.compare": ["needy:Needy", "ekf"]}))
    with pytest.raises(PluginError, match="cannot be made"):
        check_parts(load("lab", {"estimator.compare": ["needy:Needy"]}))
