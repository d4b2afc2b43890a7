"""Somebody's code may change the current folder: the results are where the user said."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import laglab as lab

Start = Callable[..., "subprocess.Popen[str]"]
Ended = Callable[..., tuple[int, str, str]]
WANDERING = """
import os
from tempfile import TemporaryDirectory

from laglab_control import Ekf
from laglab_gateway import Reading

AWAY = os.path.dirname(__file__) + "/away"

class Plant:
    def __init__(self, sample_time, start, seed):
        os.chdir(AWAY)
    def read(self):
        return Reading(*[0.0] * 8)
    def step(self, v, omega):
        os.chdir(AWAY)
    def place(self, x, y, theta):
        pass

class Filter(Ekf):
    def __init__(self, model):
        super().__init__(model)
        os.chdir(AWAY)
    def predict(self, state, u):
        os.chdir(AWAY)
        return super().predict(state, u)

class Leaving(Filter):
    def predict(self, state, u):
        with TemporaryDirectory() as folder:
            os.chdir(folder)
        return super(Filter, self).predict(state, u)
"""
STUDY = """
scenario = "lab"
[grid]
duration = [0.2]
"estimator.kind" = ["own:Filter"]
"estimator.guard" = [false]
"""
UNGUARDED = ("--set", "estimator.guard=false")
OWN = ("--set", "plant.kind=own:Plant", "--estimator", "own:Filter", "--estimator", "own:Filter")


@pytest.fixture
def away(tmp_path: Path) -> Path:
    (tmp_path / "own.py").write_text(WANDERING)
    (tmp_path / "away").mkdir()
    return tmp_path / "away"


@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_a_run_of_what_goes_elsewhere_stays(
    ended_here: Ended, tmp_path: Path, away: Path, transport: str
) -> None:
    options = ("--duration", "1", *OWN, "--transport", transport, "--out", "run")
    code, out, errors = ended_here("run", "lab", *options)
    assert code == 0, errors
    assert "results in run\n" in out
    there = {path.name for path in (tmp_path / "run").iterdir()}
    assert {"trace.csv", "arrivals.csv", "claims.csv", "summary.json", "figure.png"} <= there
    assert not list(away.iterdir())


def test_it_is_no_matter_whether_it_is_still_there(
    ended: Ended, tmp_path: Path, away: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(away.parent)
    own = ("--estimator", "own:Leaving", "--estimator", "own:Leaving", "--duration", "0.2")
    code, out, errors = ended("run", "lab", *UNGUARDED, *own, "--transport", "inline", "--out", "r")
    assert (code, errors) == (0, "")
    assert out.endswith("results in r\n")
    code, out, errors = ended("replay", "r", "--estimator", "own:Filter", "--out", "again")
    assert (code, errors) == (0, "")
    assert out.endswith("results in again\n")
    assert (tmp_path / "again" / "own%3AFilter.csv").exists()
    kept = lab.run("lab", {"duration": 0.2, "estimator.compare": ["own:Filter"]})
    assert kept.summary.compare["own:Filter"] is not None
    assert Path.cwd() == tmp_path


def test_so_does_a_study(ended: Ended, away: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(away.parent)
    (away.parent / "study.toml").write_text(STUDY)
    code, _, errors = ended("sweep", "study.toml", "--workers", "1", "--out", "study")
    assert code == 0, errors
    assert len(list((away.parent / "study" / "cells").iterdir())) == 1
    assert not list(away.iterdir())


@pytest.mark.slow
def test_so_do_the_two_sides_alone(
    start: Start,
    listening_port: Callable[["subprocess.Popen[str]"], str],
    tmp_path: Path,
    away: Path,
) -> None:
    options = ("lab", "--duration", "1", *OWN)
    gateway = start("gateway", *options, "--endpoint", "udpin://127.0.0.1:0", "--out", "robot")
    link = ("--endpoint", f"udpout://127.0.0.1:{listening_port(gateway)}")
    station = start("controller", *options, *link, "--out", "station")
    assert (station.wait(30), gateway.wait(30)) == (0, 0)
    for side in ("robot", "station"):
        there = {path.name for path in (tmp_path / side).iterdir()}
        assert {"trace.csv", "arrivals.csv", "claims.csv", "summary.json", "figure.png"} <= there
    assert not list(away.iterdir())
