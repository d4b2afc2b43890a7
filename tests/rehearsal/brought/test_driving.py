"""Filters and laws that somebody brought drive as ours do: in every process, and in studies."""

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from laglab.runs.station_side import check_parts
from laglab.scenario import load
from laglab.studies.sweep.study import Study
from laglab_control import PluginError
from laglab_gateway import read_trace

from ..studying import there

Laglab = Callable[..., "subprocess.CompletedProcess[str]"]
Ended = Callable[..., tuple[int, str, str]]
Refused = Callable[..., str]

SIDES = "robot", "station"
UNGUARDED = ("--set", "estimator.guard=false")
LAB = ("run", "lab", "--duration", "2", *UNGUARDED)
INLINE = ("--transport", "inline")


def test_a_filter_and_a_law_of_ones_own_are_as_good_as_ours(
    laglab: Laglab, ended: Ended, brought: Path
) -> None:
    assert ended(*LAB, *INLINE, "--out", "ours").code == 0
    own = ("--estimator", "mine:Wide", "--estimator", "mine:Foreseeing", "--law", "mine:Law")
    done = laglab(*LAB, *own, "--transport", "udp", "--out", "run")
    assert done.returncode == 0, done.stderr
    traces = [(brought / name / "trace.csv").read_text() for name in ("run", "ours")]
    assert traces[0] == traces[1]
    assert (brought / "run" / "shadow-mine%3AForeseeing.csv").exists()
    summary = json.loads((brought / "run" / "summary.json").read_text())
    assert summary["compare"]["mine:Foreseeing"] == summary["compare"]["mine:Wide"]
    assert (summary["estimator"], summary["law"]) == ("mine:Wide", "mine:Law")


def test_what_claims_nothing_is_recorded_and_judged_all_the_same(
    ended: Ended, brought: Path
) -> None:
    assert ended(*LAB, *INLINE, "--out", "ours").code == 0
    own = (*LAB, *INLINE, "--estimator", "mine:Unclaiming", "--out", "run")
    assert ended(*own).code == 0
    summaries = [
        json.loads((brought / name / "summary.json").read_text()) for name in ("run", "ours")
    ]
    assert summaries[0]["rms_error"]["x"] == summaries[1]["rms_error"]["x"] > 0.0
    assert not (brought / "run" / "claims.csv").exists()


@pytest.mark.usefixtures("brought")
def test_options_reach_the_class(ended: Ended, refused: Refused) -> None:
    options = (
        "--estimator", "mine:Wide", "--set", "estimator.options={spare=5}",
        "--law", "mine:Law", "--set", "law.options.gain=1.0",
    )  # fmt: skip
    assert ended(*LAB, *options, *INLINE).code == 0
    line = refused(*LAB, *options, "--set", "estimator.options.wings=2", "--force")
    assert "mine:Wide cannot be made: TypeError" in line
    assert "wings" in line


def test_what_says_where_the_robot_will_be_is_believed(brought: Path, ended: Ended) -> None:
    sent = []
    for name in ("Wide", "Foreseeing"):
        assert ended(*LAB, "--estimator", f"mine:{name}", *INLINE, "--out", name).code == 0
        sent.append(read_trace(brought / name / "trace.csv")["v_sent"])
    np.testing.assert_allclose(sent[0], sent[1], atol=1e-9)


@pytest.mark.usefixtures("brought")
def test_a_guard_needs_to_see_how_wild_a_measurement_is(ended: Ended, refused: Refused) -> None:
    guarded = ("run", "lab", "--duration", "1", "--force", *INLINE)
    assert ended(*guarded, "--estimator", "mine:Watchable").code == 0
    line = refused(*guarded, "--estimator", "mine:Wide")
    assert "estimator.guard: mine:Wide has no method innovation(state)" in line
    assert "estimator.guard = false" in line
    checked = ended("check", "mine:Wide")
    assert (checked.code, "estimator.guard = false" in checked.out) == (0, True)
    assert "estimator.guard" not in ended("check", "mine:Watchable").out


def test_who_runs_it_as_a_script_has_the_current_directory_too(brought: Path) -> None:
    """The search path of an installed command begins where the command lies."""
    command = Path(sys.executable).with_name("laglab")
    done = subprocess.run(
        [command, *LAB, "--estimator", "mine:Wide", *INLINE, "--duration", "0.1"],
        cwd=brought,
        check=False,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr


def test_two_machines_of_which_only_the_station_has_it(
    start: Callable[..., "subprocess.Popen[str]"],
    listening_port: Callable[["subprocess.Popen[str]"], str],
    tmp_path: Path,
) -> None:
    own = ("--estimator", "mine:Wide", *UNGUARDED, "--duration", "1")
    gateway = start("gateway", "lab", *own, "--endpoint", "udpin://127.0.0.1:0", "--out", "robot")
    port = listening_port(gateway)
    # The robot's side began without it.
    shutil.copy(Path(__file__).with_name("mine.py"), tmp_path)
    station = start(
        "controller", "lab", *own, "--endpoint", f"udpout://127.0.0.1:{port}", "--out", "station"
    )
    for side in (station, gateway):
        _, errors = side.communicate(timeout=60)
        assert side.returncode == 0, errors
    robot, ours = (json.loads((tmp_path / f"{each}/summary.json").read_text()) for each in SIDES)
    assert (robot["estimator"], robot["law"]) == ("the station's filter", "unknown")
    assert (ours["estimator"], ours["law"]) == ("mine:Wide", "polar")


@pytest.mark.slow
def test_they_are_replayed_judged_and_studied(ended: Ended, brought: Path) -> None:
    assert ended("run", "lab", "--duration", "1", *INLINE, "--out", "run").code == 0
    replay = ("replay", "run/robot.tlog", "--out", "again", "--estimator")
    assert ended(*replay, "mine:Wide").code == 0
    assert (brought / "again" / "mine%3AWide.csv").exists()
    code, _, stderr = ended(*replay, "mine:Failing")
    assert code == 4
    assert "laglab: tick 40: mine:Failing.correct" in stderr
    judged = ended(
        "consistency", "lab", "--duration", "1", "--seeds", "2", "--judge", "mine:Wide",
        "--judge", "delayed-ekf", "--workers", "1",
    )  # fmt: skip
    assert judged.code == 0, judged.err
    assert "mine:Wide" in judged.out


@pytest.mark.slow
@pytest.mark.timeout(120)
def test_stations_with_them_are_tried_and_studies_run_them_one_by_one(
    ended: Ended, brought: Path
) -> None:
    one = ("--seeds", "1", "--workers", "1")
    tried = ended("trust", "--only", "lab", *one, "--estimator", "mine:Watchable")
    assert tried.code == 0, tried.err
    (brought / "study.toml").write_text(
        'scenario = "lab"\nseeds = 2\n'
        '[grid]\n"estimator.kind" = ["mine:Watchable", "delayed-ekf"]\n'
    )
    studied = ended("sweep", "study.toml", "--set", "duration=1.0", "--workers", "1")
    assert studied.code == 0, studied.err
    assert "there is no mine:Watchable for many robots" in studied.out + studied.err


def test_a_run_that_fails_costs_a_study_no_other(ended: Ended, brought: Path) -> None:
    """It is said which, all else is kept, and only that is left to do."""
    (brought / "study.toml").write_text(
        'scenario = "lab"\nseeds = [3]\n[grid]\n'
        '"estimator.kind" = ["mine:Failing", "mine:Watchable", "delayed-ekf"]\n'
    )
    told = ("--set", "duration=1.0", "--set", "estimator.guard=false")
    sweep = ("sweep", "study.toml", *told, "--workers", "1", "--out", "study")
    said = "estimator.kind = mine:Failing, seed 3: tick 40: mine:Failing.correct: ValueError"
    kept = []
    for _ in range(2):
        code, _, stderr = ended(*sweep)
        assert code == 4
        assert said in " ".join(stderr.split())
        assert "Traceback" not in stderr
        kept.append(there(brought / "study"))
    assert kept[0] == kept[1]
    assert len(kept[0]) == 2


@pytest.mark.parametrize("key", ["estimator.kind", "law.kind"])
def test_a_studys_cells_are_others_when_the_module_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, key: str
) -> None:
    monkeypatch.chdir(tmp_path)
    origins = []
    for text in ("", "# changed\n"):
        (tmp_path / "own_parts.py").write_text(f"class Own:\n    pass\n{text}")
        origins.append(Study(load("lab", {key: "own_parts:Own"}), range(1, 3)).origin)
    assert origins[0] != origins[1]


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
