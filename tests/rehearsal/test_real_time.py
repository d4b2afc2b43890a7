"""Runs on the wall clock, as the command makes them."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Ended = Callable[..., Any]


def test_lateness_is_kept_apart_from_the_trace(ended_here: Ended, tmp_path: Path) -> None:
    options = ("--pace", "realtime", "--speed", "4", "--duration", "12", "--out", "run")
    assert ended_here("run", "lab", *options).code == 0
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    timing = summary["timing"]
    began_late = float((tmp_path / "run" / "timing.csv").read_text().splitlines()[1].split(",")[1])
    assert summary["wall_time_s"] > 2.99 - began_late
    assert timing.keys() == {"p50_s", "p99_s", "max_s", "missed_deadlines"}
    assert 0 < timing["p50_s"] <= timing["p99_s"] <= timing["max_s"]
    with (tmp_path / "run" / "timing.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["tick"]) for row in rows] == list(range(1201))
    lateness = [float(row["lateness"]) for row in rows]
    assert min(lateness[600:]) < 0.01  # of deadlines four times as fast: it does not add up
    assert timing["max_s"] == pytest.approx(max(lateness), abs=1e-9)
    assert "lateness" not in (tmp_path / "run" / "trace.csv").read_text()


def test_the_stamps_and_timesync_tell_of_the_real_link(ended_here: Ended, tmp_path: Path) -> None:
    options = ("--pace", "realtime", "--duration", "2", "--noise", "--out", "run")
    result = ended_here("run", "fig4", *options)
    assert result.code == 0
    link = json.loads((tmp_path / "run" / "summary.json").read_text())["link"]
    # n = 0, and still the first command can only come into force one tick after its measurement.
    assert link["command"]["measured"]["min"] == 1
    assert link["timesync"]["samples"] >= 5  # of 20; who is held up is asked, and answers, less
    assert abs(link["timesync"]["offset_s"]) < 0.05  # one machine, one clock
    assert 0 < link["timesync"]["round_trip_p50_s"] < 0.05
    assert "round trip" in result.out


def test_a_machine_that_cannot_keep_up_is_warned_of(ended_here: Ended) -> None:
    options = ("--pace", "realtime", "--speed", "5000", "--duration", "5", "--out", "run")
    result = ended_here("run", "lab", *options)
    assert "warning: " in result.err
    assert "cannot keep up" in result.err
