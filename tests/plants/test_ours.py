"""The other robots that ship, and robots that are not ours in studies."""

from pathlib import Path

import pytest

from laglab import load, run
from laglab.errors import RefusedError, RunError, ScenarioError, StudyError
from laglab.runs.plant import open_plant
from laglab.studies.many import why_one_by_one
from laglab.studies.sweep.loading import load_study
from laglab.studies.sweep.sweeping import swept
from laglab.studies.sweep.work import work_left
from laglab.studies.workers import Processes

from .building import ROVER_MAP, rover

STUDY = """
seeds = 2
[grid]
"link.command_delay" = [0, 5]
[scenario]
duration = 0.3
noise = true
[scenario.plant]
"""


def test_the_car_follows_its_circle() -> None:
    done = run("lab-car")
    assert done.summary.verdict.startswith("follows its path")
    assert done.summary.plant == "car"


def test_the_omnidirectional_one_comes_to_the_goal() -> None:
    assert run("lab-omni").summary.converged


@pytest.mark.parametrize("kind", ["car", "omni"])
def test_both_versions_give_the_same_bits_and_seeds_differ(kind: str) -> None:
    told = {"plant.kind": kind, "duration": 0.3, "noise": True}
    traces = [
        run("fig6", told | {"plant.fmi": fmi, "seed": seed}).trace["x_meas"].tolist()
        for fmi, seed in ((2, 1), (3, 1), (3, 2))
    ]
    assert traces[0] == traces[1] != traces[2]


def test_put_elsewhere_the_noise_is_another() -> None:
    scenario = load("lab-car", {"start": [0.0, 0.0, 0.0]})
    with open_plant(scenario) as opened:
        before = opened.plant.read()
        opened.plant.place(0.0, 0.0, 0.0)
        after = opened.plant.read()
    assert before[:3] == after[:3] == (0.0, 0.0, 0.0)
    assert before[3:6] != after[3:6]


@pytest.mark.parametrize(
    "key",
    ["wheel_speed_max", "motor_time_constant", "wheel_radius_error", "track_error", "wheel_slip"],
)
def test_what_only_two_wheels_have_is_refused_of_others(key: str, fmus: Path) -> None:
    load("lab", {f"plant.{key}": 0.1})
    with pytest.raises(ScenarioError, match=f"{key}: only the robot of two wheels .* not car"):
        load("lab-car", {f"plant.{key}": 0.1})
    own = {"plant.fmu": str(fmus / "Barrow.fmu")}
    names = {"plant.inputs": {"v": "twist[0]", "omega": "twist[1]"}}
    names["plant.outputs"] = {"x": "pose[0]", "y": "pose[1]", "theta": "pose[2]"}
    with pytest.raises(ScenarioError, match=f"{key}: .* not Barrow.fmu"):
        load("lab", {**own, **names, f"plant.{key}": 0.1})


def test_parameters_that_it_does_not_have_are_told() -> None:
    with pytest.raises(ScenarioError, match="parameters: robot has none that are set by name"):
        load("lab", {"plant.parameters.wheelbase": 1.0})
    with pytest.raises(RefusedError, match=r"no variable 'wheelbas'; did you mean wheelbase"):
        run("lab-car", {"plant.parameters.wheelbas": 1.0})


def study(folder: Path, plant: str) -> Path:
    (folder / "own.toml").write_text(STUDY + plant)
    return folder / "own.toml"


def test_a_study_of_a_foreign_robot_is_made_one_by_one(tmp_path: Path, fmus: Path) -> None:
    (tmp_path / "rover.fmu").write_bytes((fmus / "rover.fmu").read_bytes())
    path = study(tmp_path, f'fmu = "rover.fmu"{ROVER_MAP}')
    [(how, runs)] = work_left(load_study(str(path))).ways.items()
    assert runs == 4
    assert str(how) == "one by one: of rover.fmu there is one a run, and no fleet (plant)"
    with Processes(1) as workers:
        table = swept(str(path), workers, None, False, 100).table
    assert table.num_rows == 4
    assert table["rms_x"].null_count == 0


def test_a_robot_that_cannot_be_had_is_told_before_a_study_begins(tmp_path: Path) -> None:
    path = study(tmp_path, f'fmu = "none.fmu"{ROVER_MAP}')
    with pytest.raises(StudyError, match=r"own: with .*none.fmu: there is no such file"):
        work_left(load_study(str(path)))


def test_another_fmu_of_that_name_is_another_study(tmp_path: Path, library: Path) -> None:
    rover(tmp_path / "rover.fmu", library)
    path = study(tmp_path, f'fmu = "rover.fmu"{ROVER_MAP}')
    before = [cell.key for cell in load_study(str(path)).cells()]
    assert before == [cell.key for cell in load_study(str(path)).cells()]
    rover(tmp_path / "rover.fmu", library, resources=("gain.txt", "more.txt"))
    after = [cell.key for cell in load_study(str(path)).cells()]
    assert not set(before) & set(after)


@pytest.mark.parametrize("kind", ["robot", "car", "omni"])
def test_there_is_a_fleet_of_each_of_ours(kind: str) -> None:
    assert why_one_by_one(load("lab", {"plant.kind": kind})) is None


def test_there_is_none_of_others() -> None:
    said = "of ice:Skater there is one a run, and no fleet (plant)"
    assert why_one_by_one(load("lab", {"plant.kind": "ice:Skater"})) == said


@pytest.mark.parametrize(
    "told",
    [
        {"wheelbase": "0.5"},
        {"sample_time": 0.02},
        {"measurement_noise_gain": 2.0},
        {"v_command": 1.0},
        {"noise": 0.5},
        {"integration": 1.5},
    ],
)
def test_what_a_fleet_is_not_told_as_one_alone_is_told_to_each(told: dict[str, object]) -> None:
    """The step of a run is the scenario's, whatever the robot's own parameter says."""
    said = "one of its parameters is set for each by itself (plant.parameters)"
    parameters = {f"plant.parameters.{name}": value for name, value in told.items()}
    assert why_one_by_one(load("lab", {"plant.kind": "car", **parameters})) == said
    common = {"plant.parameters.wheelbase": 0.4, "plant.parameters.sample_time": 0.01}
    assert why_one_by_one(load("lab", {"plant.kind": "car", **common})) is None


def test_what_the_fmu_refuses_is_named_by_its_place_in_the_grid(tmp_path: Path) -> None:
    path = study(tmp_path, 'kind = "car"')
    text = path.read_text().replace("[grid]", '[grid]\n"plant.parameters.wheelbase" = [0.5, -1.0]')
    path.write_text(text)
    refused = r"own: plant.parameters.wheelbase = -1.0, link.command_delay = [05]: .* refused: .*"
    with Processes(1) as workers, pytest.raises(RunError, match=refused + r"\(and 1 more such\)"):
        swept(str(path), workers, tmp_path / "out", False, 100)
    assert len(list((tmp_path / "out" / "cells").iterdir())) == 2
