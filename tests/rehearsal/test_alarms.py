"""A run whose estimate turns out to be wrong says so, wherever somebody looks."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import laglab
from laglab.results.numbers import deviation, loop_estimates
from laglab_protocol import Statustext, read_tlog

MOVED = ("--set", "plant.event=[{at = 4.0, by = [0.5, 0.0, 0.0]}]", "--duration", "8")
AT, M, SEEN_WITHIN = 400, 20, 50


@pytest.mark.parametrize("seed", range(1, 6))
@pytest.mark.parametrize("estimator", ["delayed-ekf", "popf"])
def test_a_robot_that_was_moved_is_noticed_and_found(estimator: str, seed: int) -> None:
    overrides = {
        "estimator.kind": estimator,
        "estimator.initial_covariance": 1e-4,
        "plant.event": [{"at": 4.0, "by": [0.3, -0.4, 0.5]}],
        "seed": seed,
        "duration": 8.0,
    }
    run = laglab.run("lab", overrides)
    station = run.summary.station
    assert station is not None
    tick = station.alarms[0].tick
    assert AT + M <= tick <= AT + M + SEEN_WITHIN
    off = deviation(run.trace, loop_estimates(run.trace))
    assert np.hypot(*off[AT + M - 1, :2]) > 0.35
    assert np.hypot(*off[tick + 200, :2]) < 0.05


def test_noise_alone_is_no_alarm() -> None:
    for seed in range(1, 9):
        station = laglab.run("lab", {"seed": seed, "duration": 5.0}).summary.station
        assert station is not None
        assert station.alarms_raised == 0


@pytest.mark.parametrize(("late", "warned"), [(1100, True), (1023, False)])
def test_measurements_later_than_the_filter_remembers_are_told_of(late: int, warned: bool) -> None:
    overrides = {"estimator.kind": "popf", "link.measurement_delay": late, "duration": 12.0}
    warnings = laglab.run("lab", overrides).summary.warnings
    told = f"tick {late}: measurements come {late} ticks late: popf remembers 1023"
    assert [each.startswith(told) for each in warnings if "ticks late" in each] == [True] * warned


def test_of_late_measurements_is_told_whatever_else_the_filter_warns_of() -> None:
    late = {"distribution": "exponential", "mean": 0.3}
    overrides = {"link.measurement_delay": 1000, "link.measurement.extra_delay": late}
    warnings = laglab.run(
        "lab", {**overrides, "estimator.kind": "popf", "duration": 12.0}
    ).summary.warnings
    assert ["popf's gain is" in each for each in warnings] == [True, False]
    assert ["popf remembers 1023" in each for each in warnings] == [False, True]


def test_the_alarm_is_in_table_warning_verdict_summary_figure_and_log(
    tmp_path: Path, ended: Callable[..., Any]
) -> None:
    said = ended("run", "lab", *MOVED, "--transport", "inline", "--out", tmp_path / "r")
    assert said.code == 0
    summary = json.loads((tmp_path / "r" / "summary.json").read_text())
    (alarm,) = summary["station"]["alarms"]
    tick = alarm["tick"]
    assert re.search(rf"alarms at ticks +{tick}\b", said.out)
    assert f"after an alarm, the first at tick {tick}" in said.out
    assert f"warning: alarm at tick {tick}: {alarm['cause']}" in said.err
    texts = [
        frame.message.text.rstrip(b"\0")
        for _, frame in read_tlog(tmp_path / "r" / "robot.tlog")
        if isinstance(frame.message, Statustext) and frame.system == 1
    ]
    assert texts == [f"estimate is wrong at tick {tick}: locating".encode()]
    axes = laglab.open_run(tmp_path / "r").figure().get_axes()
    assert any("alarm" in label for each in axes for label in each.get_legend_handles_labels()[1])


def test_the_papers_scenarios_have_no_guard(rehearsed: Callable[..., dict[str, Any]]) -> None:
    summary = rehearsed("fig6", *MOVED)
    assert summary["station"]["alarms"] == []
    assert summary["converged"] is False


@pytest.mark.parametrize(
    ("event", "problem"),
    [
        ("[{at = 1.0}]", "give either place or by"),
        ("[{at = 1.0, place = [0, 0, 0], by = [0, 0, 0]}]", "give either place or by"),
        ("[{at = -1.0, by = [0, 0, 0]}]", "at"),
    ],
)
def test_somewhere_the_robot_must_be_put(
    event: str, problem: str, refused: Callable[..., str]
) -> None:
    assert problem in refused("scenario", "lab", "--set", f"plant.event={event}")


def test_it_is_put_down_at_the_tick_and_drives_on() -> None:
    event = [{"at": 1.0, "place": [1.0, 2.0, 0.5]}, {"at": 1.5, "by": [0.0, 0.0, 1.0]}]
    trace = laglab.run("fig6", {"plant.event": event, "duration": 2.0}).trace
    assert [trace[axis][100] for axis in ("x", "y", "theta")] == [1.0, 2.0, 0.5]
    assert trace["x"][99] < 0
    assert trace["theta"][150] - trace["theta"][149] == pytest.approx(1.0, abs=0.2)
    assert abs(trace["x"][110] - 1.0) > 1e-3


def test_a_robot_that_was_moved_has_noise_that_it_did_not_have_before() -> None:
    event = [{"at": 0.5, "place": [-3.0, -3.0, 0.0]}]
    trace = laglab.run("lab", {"plant.event": event, "duration": 1.0}).trace
    noise = trace["x_meas"] - trace["x"]
    assert not np.allclose(noise[:50], noise[50:100])


def test_where_the_claim_is_large_the_robot_is_slow() -> None:
    unsure = {"estimator.initial_covariance": 0.01, "estimator.initial_estimate": "start"}
    careful = laglab.run("lab", {**unsure, "duration": 0.2})
    careless = laglab.run("lab", {**unsure, "law.caution": 10.0, "duration": 0.2})
    assert careful.trace["v_sent"][0] == pytest.approx(0.5 * careless.trace["v_sent"][0])
    assert careful.trace["omega_sent"][0] == pytest.approx(0.5 * careless.trace["omega_sent"][0])


@pytest.mark.parametrize("command", ["run", "gateway"])
def test_nobody_can_move_a_real_robot_from_here(
    command: str, tmp_path: Path, refused: Callable[..., str], monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    here = ["--endpoint", "udpin://127.0.0.1:0"] if command == "gateway" else []
    line = refused(command, "lab", *MOVED, *here, "--plant", "udpout://127.0.0.1:9")
    assert "which nobody can move from here" in line
