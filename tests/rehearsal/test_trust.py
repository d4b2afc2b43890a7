"""How far each station can be trusted."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

import laglab
from laglab.studies.consistency import chi_square_bounds
from laglab.studies.judged import ALARMS, judged_run
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.compute import computed
from laglab.studies.sweep.cells.ways import how
from laglab.studies.sweep.loading import study_of, to_toml
from laglab.studies.trust import CONDITIONS, DEFAULT, score, stations, studies

SEEDS = {**dict.fromkeys(CONDITIONS, 10), "lab-radio": 30}
"""Of 10 the bounds of NEES are wide enough for a station that claims no doubt of its inputs."""
MISSING = {"all of these": 1}
"""How many of the runs may not converge; none in the other conditions."""
NEES = {"lab-radio": chi_square_bounds(SEEDS["lab-radio"]), "lab-real": (0.0, 6.0)}
"""Between which it must be, where more is asked for than to arrive."""


def test_the_command_leaves_table_and_picture_and_computes_nothing_twice(
    tmp_path, ended, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    options = ("--seeds", "1", "--workers", "1", "--only", "moved by 0.5 m", "--only", "lab")
    code, page, said = ended("trust", *options)
    assert (code, "before" in said) == (0, False)
    assert "of the position [m];" in page
    moved, lab = (
        next(line for line in page.splitlines() if line.startswith(name)).split()
        for name in ("moved by 0.5 m", "lab ")
    )
    assert moved[4:9] == ["1", "1", "0", "0", "0"]
    assert lab[1:4] == ["1", "1", "1"]
    assert (tmp_path / "trust.png").read_bytes().startswith(b"\x89PNG")

    cells = sorted((tmp_path / "studies" / "trust" / "cells").iterdir())
    times = [each.stat().st_mtime_ns for each in cells]
    assert len(cells) == 10
    cells[0].unlink()
    code, again, said = ended("trust", *options)
    assert (code, again) == (0, page)
    assert "9 of 10 runs had been made before, and are in studies/trust/cells" in said
    assert [each.stat().st_mtime_ns for each in cells][1:] == times[1:]
    assert cells[0].exists()
    code, _, said = ended("run", "fig6", "--duration", "0.1", "--out", "studies/trust")
    assert code == 2
    assert "a study's results are there: take another folder" in said


def only_cell(condition: str, station: str, seeds: int = 1) -> Cell:
    (study,) = studies([condition], {station: stations("delayed-ekf")[station]}, seeds).values()
    (cell,) = study.cells()
    return cell


@pytest.mark.parametrize("name", list(CONDITIONS))
def test_every_condition_can_be_run_with_every_station(name):
    for station in stations("delayed-ekf"):
        cell = only_cell(name, station, seeds=7)
        scenario = cell.scenario
        assert cell.seeds == tuple(range(1, 8))
        assert scenario.estimator.guard is station.endswith(", guarded")
        p0 = 1e-4 if station.startswith("popf") else 1e-3
        assert scenario.estimator.initial_covariance == p0


@pytest.mark.slow
@pytest.mark.timeout(300)  # a busy machine takes its time
@pytest.mark.parametrize("name", list(CONDITIONS))
def test_the_default_station_masters_every_condition(name):
    (runs,) = computed([only_cell(name, f"{DEFAULT}, guarded", SEEDS[name])])
    got = score(runs)
    assert got.runs - got.converged <= MISSING.get(name, 0)
    low, high = NEES.get(name, (0.0, np.inf))
    assert low <= got.nees <= high


def test_many_at_once_where_that_can_be():
    ways = {name: str(how(only_cell(name, "popf"))) for name in CONDITIONS}
    alone = [name for name, way in ways.items() if way != "in a batch"]
    assert alone == ["lab-radio", "all of these", "moved by 0.5 m"]


def test_the_scores_are_those_of_the_runs():
    runs = {
        "converged": [True, False, True, False],
        "rms_x": [0.3, 0.4, 0.0, None],
        "rms_y": [0.0, 0.0, 0.0, None],
        "nees": [3.0, 3.0, 6.0, None],
        "alarm_s": [None, 1.0, 2.0, 3.0],
        "alarm_error": [None, 0.01, 0.2, None],
    }
    of_these = score(pa.table(runs))
    assert (of_these.runs, of_these.converged, of_these.alarmed) == (4, 2, 3)
    assert of_these.rms == pytest.approx((0.25 / 3) ** 0.5)
    assert of_these.nees == 4.0
    assert of_these.found == 0.5


def test_the_error_after_the_first_alarm_is_looked_at_two_seconds_later():
    run = laglab.run("lab-real", {"duration": 4.0})
    first = run.alarms[0]
    off = [run.trace[f"{axis}_est"][first + 200] - run.trace[axis][first + 200] for axis in "xy"]
    judged = judged_run(run)
    assert judged.alarm_s == pytest.approx([first * 0.01])
    assert judged.alarm_error == pytest.approx([np.hypot(*off)])
    short = judged_run(laglab.run("lab-real", {"duration": first * 0.01 + 1.9}))
    assert short.alarm_s == judged.alarm_s
    assert np.isnan(short.alarm_error).all()


STUDY = """
scenario = "lab-real"
grid = { duration = [1.0, 3.5] }
"""


def test_an_alarm_is_told_where_it_is_asked_for(tmp_path: Path):
    (tmp_path / "quiet.toml").write_text(STUDY)
    (tmp_path / "told.toml").write_text(f"also = {list(reversed(ALARMS))}{STUDY}")
    quiet, told = (laglab.load_study(str(tmp_path / f"{name}.toml")) for name in ("quiet", "told"))
    assert read_back(told, tmp_path) == [cell.key for cell in told.cells()]
    assert not {cell.key for cell in quiet.cells()} & {cell.key for cell in told.cells()}
    short, long = computed(list(told.cells()))
    known = computed([next(quiet.cells())])[0].column_names
    assert [name for name in long.column_names if name not in known] == list(ALARMS)
    assert short["alarm_s"].to_pylist() == long["alarm_s"].to_pylist() != [None]
    assert short["alarm_error"].to_pylist() == [None] != long["alarm_error"].to_pylist()


def read_back(study: laglab.Study, folder: Path) -> list[str]:
    """The keys of the cells of what is written down of it."""
    again, origin = study_of(to_toml(study, study.origin), "told", folder / "told.toml")
    return [cell.key for cell in again.cells(origin)]


@pytest.mark.parametrize("options", [("--only", "nonsense"), ("--estimator", "nonsense")])
def test_what_is_not_known_is_one_line(options, refused):
    said = refused("trust", *options)
    assert "not one of" in said or "must be one of" in said
    assert "'nonsense'" in said


def test_a_filter_that_cannot_be_had_is_told_before_anything_runs(ended, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, said = ended("trust", "--only", "lab", "--seeds", "1", "--estimator", "nowhere:Filter")
    assert code == 2
    assert "nowhere:Filter" in said
    assert len(said.splitlines()) == 1
    assert not list(tmp_path.iterdir())
