"""What a run leaves behind, and what it does not."""

import csv
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pymavlink
import pytest

import laglab
from laglab.results.numbers import has_converged
from laglab.scenario import load
from laglab_gateway import read_trace

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Ended = Callable[..., Any]
Python = Callable[..., str]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory, laglab_in: Callable[[Path], Laglab]) -> Path:
    folder = tmp_path_factory.mktemp("fig8")
    result = laglab_in(folder)("run", "fig8", "--seed", "3", "--duration", "2", "--out", "run")
    assert result.returncode == 0, result.stderr
    assert "× real time" in result.stdout
    return folder / "run"


def test_the_trace_has_a_row_for_every_tick(run: Path) -> None:
    with (run / "trace.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["tick"]) for row in rows] == list(range(201))
    header = (run / "trace.csv").read_text().splitlines()[0]
    assert header == (
        "tick,time,x,y,theta,x_meas,y_meas,theta_meas,x_est,y_est,theta_est,"
        "v_sent,omega_sent,v,omega"
    )
    assert all(repr(float(row["x"])) == row["x"] for row in rows)


def test_the_command_in_force_was_sent_n_ticks_earlier(run: Path) -> None:
    trace = read_trace(run / "trace.csv")
    assert (trace["v"][:10] == 0).all()
    np.testing.assert_array_equal(trace["v"][10:], trace["v_sent"][:-10])
    np.testing.assert_array_equal(trace["omega"][10:], trace["omega_sent"][:-10])


def test_the_summary_says_how_it_went(run: Path) -> None:
    summary = json.loads((run / "summary.json").read_text())
    assert summary.keys() >= {
        "scenario", "estimator", "n", "m", "seed", "transport", "ticks", "final", "rms_error",
        "converged", "verdict", "wall_time_s", "real_time_factor",
    }  # fmt: skip
    assert summary["final"].keys() == {"rho", "theta_error", "v", "omega"}
    assert (summary["n"], summary["m"], summary["seed"], summary["ticks"]) == (10, 20, 3, 200)
    assert summary["transport"] == "udp"
    trace = read_trace(run / "trace.csv")
    settled = (trace["x_est"] - trace["x"])[20:]
    assert summary["rms_error"]["x"] == pytest.approx(np.sqrt(np.mean(settled**2)))


def test_the_scenario_reads_back_to_what_was_run(run: Path) -> None:
    again = load(str(run / "scenario.toml"))
    assert again == load("fig8", {"seed": 3, "duration": 2.0})


def test_the_log_is_readable_by_mavlogdump(run: Path, pymavlink_of_ones_own: Python) -> None:
    """By the installed program itself, after what the README says."""
    installed = pymavlink_of_ones_own(sys.executable, "-m", "laglab", "protocol", "install")
    assert installed.endswith("pymavlink/dialects/v20/laglab.py\n")
    dump = (str(Path(sys.executable).parent / "mavlogdump.py"), "--dialect", "laglab")
    said = pymavlink_of_ones_own(*dump, "--format", "json", str(run / "robot.tlog"))
    messages = [json.loads(line) for line in said.splitlines()]
    assert {"HEARTBEAT", "LAGLAB_TICK", "LAGLAB_COMMAND"} <= {_name(each) for each in messages}
    measured = [each["data"] for each in messages if _name(each) == "LAGLAB_MEASUREMENT"]
    assert measured[0].keys() == {"x", "y", "theta", "v", "omega", "tick", "command_tick"}
    trace = read_trace(run / "trace.csv")
    assert [each["theta"] for each in measured] == trace["theta_meas"][: len(measured)].tolist()


def _name(message: dict[str, dict[str, str]]) -> str:
    return message["meta"]["type"]


@pytest.fixture
def pymavlink_of_ones_own(tmp_path: Path) -> Python:
    """Runs a program where what is put into pymavlink does not stay: its output."""
    folder = Path("pymavlink/dialects/v20")
    for name in ("pymavlink", "pymavlink/dialects", "pymavlink/dialects/v20"):
        (tmp_path / "own" / name).mkdir(parents=True)
        for there in Path(pymavlink.__path__[0]).parent.joinpath(name).iterdir():
            if name == str(folder) or there.name not in folder.parts:
                (tmp_path / "own" / name / there.name).symlink_to(there)

    def call(*command: str) -> str:
        return subprocess.run(
            command,
            env=os.environ | {"PYTHONPATH": str(tmp_path / "own"), "PYTHONWARNINGS": "ignore"},
            capture_output=True,
            text=True,
            timeout=60,
            check=True,
        ).stdout

    return call


def test_the_figure_is_a_picture(run: Path) -> None:
    assert (run / "figure.png").read_bytes().startswith(b"\x89PNG")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_an_earlier_run_is_not_overwritten(ended: Ended, folder: Path) -> None:
    for _ in range(2):
        assert ended("run", "fig4", "--duration", "0.1", "--transport", "inline").code == 0
    assert sorted(path.name for path in (folder / "runs").iterdir()) == ["fig4", "fig4-2"]


def test_compare_draws_what_two_runs_left(ended: Ended, folder: Path) -> None:
    for name in ("fig4", "fig5"):
        laglab.run(name, {"duration": 1.0}, out=name)
    assert ended("compare", "fig4", "fig5", "--out", "both.png").code == 0
    assert (folder / "both.png").read_bytes().startswith(b"\x89PNG")


def test_scenarios_lists_all_that_ship(ended: Ended) -> None:
    listed = ended("scenarios").out
    for name in ("fig4", "fig5", "fig6", "fig7", "fig8", "lab"):
        assert name in listed


def test_a_report_is_left_where_one_is_asked_for(ended: Ended, folder: Path) -> None:
    short = ("run", "fig4", "--transport", "inline", "--duration", "0.5", "--out", "run")
    done = ended(*short, "--report")
    assert done.code == 0, done.err
    assert "report in run/report.html" in done.out
    assert "fig4" in (folder / "run" / "report.html").read_text("utf-8")


@pytest.mark.parametrize("noise", [True, False])
def test_the_table_says_when_there_is_no_noise(ended: Ended, folder: Path, noise: bool) -> None:
    """Else who reads of errors of 1e-16 m wonders."""
    short = ("--duration", "0.1", "--transport", "inline", "--out", str(folder / "run"))
    done = ended("run", "fig4", *short, "--noise" if noise else "--no-noise")
    assert done.code == 0, done.err
    assert ("without noise" in done.out) is not noise


def test_where_the_last_measurements_are_still_on_their_way_the_others_tell() -> None:
    ticks, axes = 300, ("x", "y", "theta")
    trace = {"time": np.arange(ticks) * 0.01} | {axis: np.full(ticks, np.nan) for axis in axes}
    measured = np.random.default_rng(1).normal(0, 0.05, ticks)
    measured[-20:] = np.nan
    trace |= {f"{axis}_meas": measured for axis in axes}
    assert has_converged(trace, (0.0, 0.0, 0.0))
    assert not has_converged(trace, (0.2, 0.0, 0.0))
    backwards = trace | {"theta_meas": np.pi + 3 * measured}
    assert not has_converged(backwards, (0.0, 0.0, 0.0))
    assert has_converged(backwards, (0.0, 0.0, np.pi))


FAILING = """
class Law:
    def __init__(self, goal): pass
    def drive(self, pose, time, memory): raise ValueError("no more")
"""


def test_a_verdict_names_the_tick_of_a_failure_once(ended: Ended, folder: Path) -> None:
    (folder / "failing.py").write_text(FAILING)
    ended("run", "lab", "--law", "failing:Law", "--transport", "inline", "--out", "run")
    said = laglab.open_run("run").summary.verdict
    assert re.fullmatch(
        r"stopped at tick \d+: failing:Law\.drive: ValueError: no more \(failing\.py, line 4\)",
        said,
    )


@pytest.mark.parametrize("name", ["run\0", "x" * 5000], ids=["0", "long"])
def test_what_no_folder_can_be_called_is_told_from_python_too(name: str) -> None:
    with pytest.raises(laglab.ResultsError, match=r"is no name of a folder|is not there"):
        laglab.open_run(name)
