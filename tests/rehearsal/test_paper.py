"""The paper's scenarios do what the paper, or its errata, say."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from laglab.results.numbers import loop_estimates
from laglab.results.shadows import shadow_rows
from laglab.scenario import load
from laglab_gateway import read_trace
from laglab_station import read_session

Rehearsed = Callable[..., dict[str, Any]]


@pytest.mark.parametrize("name", ["fig4", "fig6", "fig7"])
def test_converges(rehearsed: Rehearsed, name: str) -> None:
    summary = rehearsed(name)
    assert summary["converged"]
    assert summary["verdict"].startswith("converged")


def test_a_goal_far_from_the_origin_is_one_like_any_other(rehearsed: Rehearsed) -> None:
    assert rehearsed("lab", "--goal", "5000,5000,0", "--start", "4997,4997,0")["converged"]


def test_fig5_reaches_the_goal_but_keeps_turning(rehearsed: Rehearsed) -> None:
    summary = rehearsed("fig5")
    assert not summary["converged"]
    assert summary["final"]["rho"] < 0.5
    assert abs(summary["final"]["omega"]) > 1.5
    assert summary["rms_error"] is None


def test_fig5_without_limits_diverges(rehearsed: Rehearsed, tmp_path: Path) -> None:
    own = tmp_path / "unlimited.toml"
    own.write_text('estimator.kind = "raw"\n')
    rehearsed(str(own), exit_code=3)
    assert np.abs(read_trace(tmp_path / "run" / "trace.csv")["v"]).max() > 100


def test_fig6_is_exact_without_noise(rehearsed: Rehearsed) -> None:
    summary = rehearsed("fig6")
    assert max(summary["rms_error"].values()) < 1e-9
    assert summary["final"]["rho"] < 1e-6
    assert abs(summary["final"]["theta_error"]) < 1e-6


def test_fig8_popf_deviates_less_than_ekf_in_all_three(rehearsed: Rehearsed) -> None:
    compare = rehearsed("fig8")["compare"]
    for axis in ("x", "y", "theta"):
        assert compare["popf"][axis] < compare["ekf"][axis]


def test_fig8_replays_to_what_the_loop_estimated(rehearsed: Rehearsed, tmp_path: Path) -> None:
    rehearsed("fig8")
    trace = read_trace(tmp_path / "run" / "trace.csv")
    session = list(read_session(tmp_path / "run" / "robot.tlog"))
    replayed = [row.x for row in shadow_rows(load("fig8"), "popf", session)]
    np.testing.assert_array_equal(replayed, loop_estimates(trace))


def test_lab_converges(rehearsed: Rehearsed) -> None:
    assert rehearsed("lab")["converged"]


def test_popf_printed_is_a_misprint(rehearsed: Rehearsed) -> None:
    summary = rehearsed("fig6", "--estimator", "popf-printed")
    assert not summary["converged"]
    measured = [round(summary["rms_error"][axis], 2) for axis in ("x", "y", "theta")]
    assert measured == [0.15, 0.18, 0.04]
