"""How far each station can be trusted."""

from types import SimpleNamespace

import numpy as np
import pytest

import laglab
from laglab.studies.trust import CONDITIONS, Fared, Trial, scores, stations
from laglab.studies.trust.trials import _late_error


def test_the_command_leaves_table_and_picture(tmp_path, ended, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ("--seeds", "1", "--workers", "1", "--only", "moved by 0.5 m", "--only", "lab")
    code, page, _ = ended("trust", *options)
    assert code == 0
    assert "of the position [m];" in page
    moved, lab = (
        next(line for line in page.splitlines() if line.startswith(name)).split()
        for name in ("moved by 0.5 m", "lab ")
    )
    assert moved[4:9] == ["1", "1", "0", "0", "0"]
    assert lab[1:4] == ["1", "1", "1"]
    assert (tmp_path / "trust.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", list(CONDITIONS))
def test_every_condition_can_be_run_with_every_station(name):
    for station, how in stations("delayed-ekf").items():
        scenario = Trial(name, station, how, seed=7).scenario
        assert scenario.seed == 7
        assert scenario.estimator.guard is station.endswith(", guarded")
        p0 = 1e-4 if station.startswith("popf") else 1e-3
        assert scenario.estimator.initial_covariance == p0


def test_the_scores_are_those_of_the_runs():
    def one(converged, x, alarmed=False, late=None):
        return Fared("lab", "popf", converged, (x, 0.0, 0.0), 3.0, alarmed, late)

    runs = [one(True, 0.3), one(False, 0.4, True, 0.01), one(True, 0.0, True, 0.2)]
    score = scores(runs)["lab", "popf"]
    assert (score.runs, score.converged, score.alarmed) == (3, 2, 2)
    assert score.rms == pytest.approx((0.25 / 3) ** 0.5)
    assert score.found == 0.5


def test_the_error_after_an_alarm_is_looked_at_two_seconds_later():
    run = laglab.run("lab", {"duration": 4.0})
    off = [run.trace[f"{axis}_est"][300] - run.trace[axis][300] for axis in ("x", "y")]

    def late_error(*alarms):
        return _late_error(SimpleNamespace(alarms=alarms, trace=run.trace, scenario=run.scenario))

    assert late_error(100, 350) == pytest.approx(np.hypot(*off))
    assert late_error(201) is late_error() is None


@pytest.mark.parametrize("options", [("--only", "nonsense"), ("--estimator", "nonsense")])
def test_what_is_not_known_is_one_line(options, refused):
    said = refused("trust", *options)
    assert "not one of" in said or "must be one of" in said
    assert "'nonsense'" in said
