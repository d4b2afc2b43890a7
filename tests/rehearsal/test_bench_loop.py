"""The loops that the benchmark compares do the same work."""

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import laglab
from laglab.bench import by_hand
from laglab.bench.loop import TRANSPORTS, loop_scenario
from laglab.bench.round_trip import seconds_per_echo, tick_sizes
from laglab_gateway import read_trace


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_the_loop_by_hand_leaves_our_trace(tmp_path: Path, transport: str) -> None:
    scenario = loop_scenario("popf", ticks=60)
    assert 0 < by_hand.seconds_per_tick(transport, scenario, tmp_path) < 1
    theirs = read_trace(tmp_path / "trace.csv")
    laglab.run(scenario, out=tmp_path / "ours")
    ours = read_trace(tmp_path / "ours" / "trace.csv")
    for column, values in ours.items():
        np.testing.assert_array_equal(theirs[column], values, err_msg=column)
    assert np.abs(ours["v"]).max() > 0


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_the_echo_carries_as_many_bytes_as_a_tick(tmp_path: Path, transport: str) -> None:
    sizes = tick_sizes(estimates=True)
    assert 0 < seconds_per_echo(transport, sizes, ticks=50) < 0.1
    laglab.run(loop_scenario("popf", ticks=60), out=tmp_path)
    frames = (tmp_path / "robot.tlog").stat().st_size / 61
    assert sizes.to_station + sizes.to_robot + 4 * 8 == pytest.approx(frames, rel=0.3)


@pytest.mark.slow
def test_the_benchmark_says_what_each_way_costs(
    laglab: Callable[..., subprocess.CompletedProcess[str]],
) -> None:
    result = laglab(
        "bench", "loop", "--rounds", "1", "--ticks", "100", "--realtime", "1", "--link", "udp"
    )
    assert result.returncode == 0, result.stderr
    rows = re.findall(
        r"(udp|serial) +(popf|raw)((?: +[\d.]+ \([\d]+\)){3}(?: +[\d.]+){3})", result.stdout
    )
    assert [row[:2] for row in rows] == [("udp", "popf"), ("udp", "raw")]
    assert all(
        float(number) > 0 for *_, numbers in rows for number in re.findall(r"[\d.]+", numbers)
    )
    assert "real time, late by: p50" in result.stdout
