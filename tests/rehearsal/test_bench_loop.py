"""The loops that the benchmark compares do the same work."""

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
import pytest

import laglab
from laglab.bench import Report, whole_run
from laglab.bench.by_hand import Link, seconds_per_echo, tick_sizes
from laglab.bench.by_hand import loop as by_hand
from laglab.bench.loop import LINKS
from laglab.bench.whole_run import loop_scenario
from laglab.runs.ending import Ending
from laglab_gateway import Outcome, read_trace
from laglab_protocol import EndReason


@pytest.mark.parametrize("link", LINKS)
def test_the_loop_by_hand_leaves_our_trace(tmp_path: Path, link: Link) -> None:
    scenario = loop_scenario("popf", ticks=60)
    assert 0 < by_hand.seconds_per_tick(link, scenario, tmp_path) < 1
    theirs = read_trace(tmp_path / "trace.csv")
    laglab.run(scenario, out=tmp_path / "ours")
    ours = read_trace(tmp_path / "ours" / "trace.csv")
    for column, values in ours.items():
        np.testing.assert_array_equal(theirs[column], values, err_msg=column)
    assert np.abs(ours["v"]).max() > 0


@pytest.mark.parametrize("link", LINKS)
def test_the_echo_carries_as_many_bytes_as_a_tick(tmp_path: Path, link: Link) -> None:
    sizes = tick_sizes(estimates=True)
    assert 0 < seconds_per_echo(link, sizes, ticks=50) < 0.1
    laglab.run(loop_scenario("popf", ticks=60), out=tmp_path)
    frames = (tmp_path / "robot.tlog").stat().st_size / 61
    assert sizes.to_station + sizes.to_robot + 4 * 8 == pytest.approx(frames, rel=0.3)


@pytest.mark.slow
def test_the_benchmark_says_what_each_way_costs(
    tmp_path: Path, laglab: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    short = ("--rounds", "1", "--ticks", "100", "--realtime", "1", "--link", "udp")
    result = laglab("bench", "loop", *short, "--json", "loop.json")
    assert result.returncode == 0, result.stderr
    report = msgspec.json.decode((tmp_path / "loop.json").read_bytes(), type=Report)
    timings = {(each.case, each.name): each for each in report.results[0].timings}
    assert list(timings) == [
        (case, way)
        for case in ("udp, popf", "udp, raw")
        for way in ("bare echo", "by hand", "laglab")
    ]
    alone = ("popf", "raw") if hasattr(os, "sched_setaffinity") else ()
    assert [(each.case, each.name) for result in report.results[1:] for each in result.timings] == [
        (case, way) for case in ("popf", "raw", *alone, "fig6", "lab") for way in ("inline", "udp")
    ]
    figures = {(each.name, each.unit): each.value for each in report.figures}
    ours = timings["udp, popf", "laglab"]
    assert figures["udp, popf: laglab", "× real time"] == pytest.approx(1e4 / ours.fastest)
    assert figures["real time, late by: p50", "ms"] > 0
    assert "udp, popf: laglab" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize("link", LINKS)
def test_a_run_that_was_interrupted_is_no_figure(
    link: Link, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It ends in order, as Ctrl-C has any run end; the bench is to end with it."""

    def interrupted(*_: object) -> Ending:
        return Ending(Outcome(EndReason.INTERRUPTED, 7), loop_seconds=0.1)

    monkeypatch.setattr(whole_run, "run_into", interrupted)
    with pytest.raises(KeyboardInterrupt):
        whole_run.seconds_per_tick(link, loop_scenario("raw", 100), tmp_path)
