"""Runs that follow a path: what is said and drawn of them, and what a path may be."""

import csv
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import laglab
from laglab.errors import ScenarioError
from laglab.results.figures import draw_run, draw_runs
from laglab.results.report import report_html
from laglab.results.table import summary_rows
from laglab.scenario import load
from laglab.studies.many import why_one_by_one
from laglab.studies.sweep.cells.one_by_one import judged_alone
from laglab.studies.sweep.study import Study

Rehearsed = Callable[..., dict[str, Any]]
HEAD = "time,x,y,theta,v,omega\n"
STRAIGHT = HEAD + "0,0,0,0,0.5,0\n6,3,0,0,0.5,0\n"


@pytest.fixture(scope="module")
def circling() -> laglab.Run:
    return laglab.run("track-circle", {"duration": 12.0})


def test_what_ships_follows_its_path_over_two_processes_as_in_one() -> None:
    apart, inline = (
        laglab.run("track-eight", {"duration": 8.0}, transport=transport)
        for transport in ("udp", "inline")
    )
    assert all(apart.trace[name].tobytes() == inline.trace[name].tobytes() for name in apart.trace)
    assert apart.summary.converged
    assert apart.summary.following is not None
    assert apart.summary.following.largest < 0.03
    assert apart.summary.verdict.startswith("follows its path: 0.0")


def test_distances_are_those_over_the_second_half(circling: laglab.Run) -> None:
    trace, scenario = circling.trace, circling.scenario
    assert scenario.path is not None
    wanted = scenario.path.sampled(np.arange(1201) * 0.01)
    distance = np.hypot(trace["x"] - wanted[:, 0], trace["y"] - wanted[:, 1])[600:]
    following = circling.summary.following
    assert following is not None
    assert following.rms == pytest.approx(np.sqrt(np.mean(distance**2)))
    assert following.largest == pytest.approx(distance.max())
    assert circling.summary.final.rho == pytest.approx(distance[-1])
    assert summary_rows(circling)["distance to the path"].startswith("RMS 0.0")


def test_a_robot_that_is_slower_than_its_path_does_not_follow_it() -> None:
    late = laglab.run("track-circle", {"duration": 6.0, "law.v_max": 0.3})
    assert not late.summary.converged
    assert late.summary.verdict.startswith("does not follow its path: ")


def test_accelerations_are_limited_in_what_is_sent(circling: laglab.Run) -> None:
    law = circling.scenario.law
    for name, most in (("v_sent", law.accel_max), ("omega_sent", law.alpha_max)):
        assert most is not None
        steps = np.abs(np.diff(circling.trace[name])) / 0.01
        assert steps.max() <= most * (1 + 1e-9)
        assert steps.max() > 0.9 * most


def test_figures_and_page_show_the_path(circling: laglab.Run) -> None:
    for figure in (draw_run(circling), draw_runs([circling, circling])):
        (path,) = (axes for axes in figure.axes if axes.get_label() == "path")
        (drawn,) = (line for line in path.lines if line.get_label() == "path")
        radius = np.hypot(*np.asarray(drawn.get_data(), dtype=float))
        assert radius == pytest.approx(1.5)
        assert "goal" not in [line.get_label() for line in path.lines]
    page = report_html([circling])
    assert "to the path: " in page
    assert "follows its path" in page


def test_a_study_judges_by_the_path_one_run_after_the_other() -> None:
    scenario = load("track-circle", {"duration": 6.0})
    assert why_one_by_one(scenario) == "there is no law tracking for many robots"
    (cell,) = Study(scenario, (1,)).cells()
    judged = judged_alone(cell, *cell.runs())
    assert judged.converged.all()
    assert judged.final_rho[0] < 0.03
    assert 0 < judged.settled_s[0] < 5


def test_a_csv_lies_beside_the_scenario_and_is_found_from_anywhere(
    tmp_path: Path, rehearsed: Rehearsed
) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "way.csv").write_text(STRAIGHT)
    (folder / "mine.toml").write_text(
        'start = [0, 0, 0]\nduration = 8\nlaw = { kind = "tracking", path = "way.csv" }\n'
    )
    summary = rehearsed(str(folder / "mine.toml"))
    assert summary["converged"]
    assert summary["law"] == "tracking"
    assert summary["schema_version"] == 4
    assert summary["following"].keys() == {"rms", "largest"}
    # Without noise, and n ticks late at first: the robot catches up, and stands where it ends.
    assert summary["final"]["v"] == pytest.approx(0.0, abs=1e-3)
    kept = load(str(tmp_path / "run" / "scenario.toml"))
    assert kept.law.path == str(folder / "way.csv")
    written = kept.to_toml(tmp_path)
    assert 'path = "mine/way.csv"' in written
    trace = laglab.open_run(tmp_path / "run").trace
    assert trace["x"][-1] == pytest.approx(3.0, abs=0.01)


def test_columns_may_stand_in_any_order_and_others_beside_them(tmp_path: Path) -> None:
    with (tmp_path / "way.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["note", "x", "time", "omega", "v", "theta", "y"])
        writer.writerow(["a", 1, 0, 6, 5, 3, 2])
    told = {"law.kind": "tracking", "law.path": str(tmp_path / "way.csv")}
    path = load("lab", told).path
    assert path is not None
    assert path.at(0.0) == (1, 2, 3, 5, 6)


def test_a_long_path_is_not_copied_at_every_tick(tmp_path: Path) -> None:
    rows = "".join(f"{row},{row / 1000},0,0,0.1,0\n" for row in range(20_000))
    (tmp_path / "way.csv").write_text(HEAD + rows)
    told = {"law.kind": "tracking", "law.path": str(tmp_path / "way.csv"), "goal": [10.0, 0.0, 0.0]}
    path = load("lab", told).path
    assert path is not None
    assert path.at(5.5).x == pytest.approx(0.0055)
    tracemalloc.start()
    path.at(6.5)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 20_000


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD, "a row of x, y, theta, v, omega for each time"),
        ("time,x,y,theta\n0,0,0,0\n", "no v, omega"),
        (HEAD + "0,0,0,0,0,0\n1,0,zero,0,0,0\n", "line 3: must be 6 finite numbers"),
        (HEAD + "0,0,0,0,0,0\n1,0,nan,0,0,0\n", "line 3: must be 6 finite numbers"),
        (HEAD + "0,0,0,0,0\n", "line 2: must be 6 finite numbers"),
        (HEAD + "1,0,0,0,0,0\n1,0,0,0,0,0\n", "times of a path must grow"),
        (HEAD + "1,5000,0,0,0,0\n", "within 1000 m of the goal"),
        ("\x00\xff", "not a readable CSV file"),
    ],
)
def test_what_is_no_path_is_said_in_a_line(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "way.csv").write_text(text, encoding="latin-1")
    told = {"law.kind": "tracking", "law.path": str(tmp_path / "way.csv")}
    with pytest.raises(ScenarioError) as error:
        load("lab", told)
    assert said in str(error.value)
    assert "law.path" in str(error.value)


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"law.kind": "tracking"}, "law: path: tracking follows one"),
        ({"law.path": "circle(1, 1)"}, "law: path: the polar law follows none"),
        ({"law.options.k_x": 1.0}, "law: options: the polar law has none"),
        ({"law.kind": "spiral"}, "law.kind: must be one of polar, tracking, or module:Class"),
        ({"law.kind": "tracking", "law.path": "circle(1)"}, "radius, speed must be numbers"),
        ({"law.kind": "tracking", "law.path": "eight(-1, 1)"}, "width must be a finite number"),
        ({"law.kind": "tracking", "law.path": "eight(1e-200, 1)"}, "width must be a finite number"),
        ({"law.kind": "tracking", "law.path": "circle(1, 1e300)"}, "1e-09 or more, and at most 1e"),
        ({"law.kind": "tracking", "law.path": "oval(1, 1)"}, "must be circle(radius, speed)"),
        ({"law.kind": "tracking", "law.path": "no.csv"}, "No such file or directory"),
    ],
)
def test_what_a_scenario_refuses(told: dict[str, object], said: str) -> None:
    with pytest.raises(ScenarioError) as error:
        load("lab", told)
    assert said in str(error.value)


def test_an_option_that_tracking_does_not_have(tmp_path: Path, refused: Callable[..., str]) -> None:
    options = ("--set", "law.options.k_z=1", "--transport", "inline", "--out", tmp_path / "run")
    line = refused("run", "track-circle", *options)
    assert "law.options: tracking has k_x, k_y, k_theta, not k_z" in line


def test_the_target_of_a_run_without_a_path_is_its_goal() -> None:
    told = load("lab", {"goal": (1.0, 2.0, 3.0)}).target
    assert told.poses(np.arange(3.0)).tolist() == [[1.0, 2.0, 3.0]] * 3
    assert told.outline().tolist() == [[1.0, 2.0]]
