"""The paper's scenarios do what the paper, or its errata, say."""

from pathlib import Path

import numpy as np
import pytest

import laglab
from laglab.results.numbers import loop_estimates
from laglab.results.shadows import shadow_rows
from laglab.runs.whole import run_into
from laglab.scenario import load
from laglab_gateway import read_trace
from laglab_station import read_session

AXES = ("x", "y", "theta")


@pytest.mark.parametrize("name", ["fig4", "fig6", "fig7", "lab"])
def test_converges(name: str) -> None:
    summary = laglab.run(name).summary
    assert summary.converged
    assert summary.verdict.startswith("converged")
    if name == "fig6":
        assert summary.rms_error is not None
        assert max(getattr(summary.rms_error, axis) for axis in AXES) < 1e-9
        assert summary.final.rho < 1e-6
        assert abs(summary.final.theta_error) < 1e-6


def test_a_goal_far_from_the_origin_is_one_like_any_other() -> None:
    far = {"goal": [5000.0, 5000.0, 0.0], "start": [4997.0, 4997.0, 0.0]}
    assert laglab.run("lab", far).summary.converged


def test_fig5_reaches_the_goal_but_keeps_turning() -> None:
    summary = laglab.run("fig5").summary
    assert not summary.converged
    assert summary.final.rho < 0.5
    assert abs(summary.final.omega) > 1.5
    assert summary.rms_error is None


def test_fig5_without_limits_diverges(tmp_path: Path) -> None:
    own = tmp_path / "unlimited.toml"
    own.write_text('estimator.kind = "raw"\n')
    run = laglab.run(own)
    assert run.summary.outcome == "diverged"
    assert np.abs(run.trace["v"]).max() > 100


def test_fig8_popf_deviates_less_than_ekf_in_all_three() -> None:
    compare = laglab.run("fig8").summary.compare
    for axis in AXES:
        assert getattr(compare["popf"], axis) < getattr(compare["ekf"], axis)


def test_fig8_replays_to_what_the_loop_estimated(tmp_path: Path) -> None:
    run_into(tmp_path, load("fig8"), "inline", lambda *_: None)
    session = list(read_session(tmp_path / "robot.tlog"))
    replayed = [row.x for row in shadow_rows(load("fig8"), "popf", session)]
    np.testing.assert_array_equal(replayed, loop_estimates(read_trace(tmp_path / "trace.csv")))


def test_popf_printed_is_a_misprint() -> None:
    summary = laglab.run("fig6", {"estimator.kind": "popf-printed"}).summary
    assert not summary.converged
    assert [round(getattr(summary.rms_error, axis), 2) for axis in AXES] == [0.15, 0.18, 0.04]
