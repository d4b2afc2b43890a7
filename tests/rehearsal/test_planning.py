"""Plans: while nothing newer comes the robot goes on by what was planned for that time."""

import io
import re
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import laglab
from laglab.errors import ScenarioError
from laglab.results.link_view import link_view
from laglab.results.run import Run
from laglab.results.table import results_table

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Keys = Mapping[str, object]
POSE = ("x", "y", "theta")


def run(scenario: str, *overrides: Keys) -> Run:
    together: dict[str, object] = {}
    for each in overrides:
        together.update(each)
    return laglab.run(scenario, together)


def same_poses(run: Run, other: Run, atol: float = 1e-9) -> None:
    for axis in POSE:
        np.testing.assert_allclose(run.trace[axis], other.trace[axis], rtol=0, atol=atol)


def longest_gap(run: Run) -> int:
    """Ticks for which no command came."""
    came = run.arrivals
    followed = (came["direction"] == "command") & (came["refused"] == "no")
    return int(np.diff(came["arrived"].astype(int)[followed]).max())


def from_then_on(link: Keys, at: float = 0.3) -> Keys:
    """What the link does to commands once the robot has a plan; before the first it stands still,
    whatever is planned."""
    event = {"at": at, "link": link, "direction": "command"}
    return {"link.event": [event]}


SHORT = {"duration": 5.0}
LOSING = from_then_on({"loss": 0.1})
BURSTS = from_then_on({"burst": {"good_to_bad": 0.01, "bad_to_good": 0.04}})
OUTAGES = from_then_on({"outages": [[0.6, 0.9], [2.0, 0.7]]})


@pytest.mark.parametrize("lost", [LOSING, BURSTS, OUTAGES], ids=["losses", "bursts", "outages"])
@pytest.mark.parametrize("estimator", ["popf", "delayed-ekf"])
def test_losing_commands_changes_nothing(estimator: str, lost: Keys) -> None:
    """The property that plans are for: noise off, x^_0 exact, H longer than any gap."""
    kind = {"estimator.kind": estimator}
    undisturbed = run("fig6", SHORT, kind)
    planned = run("fig6", SHORT, kind, lost, {"link.plan": 110})
    assert 5 < longest_gap(planned) <= 110
    same_poses(planned, undisturbed)
    assert planned.summary.link is not None
    assert planned.summary.link.stops == 0  # nor does the failsafe, though a gap is longer than it

    held = run("fig6", SHORT, kind, lost)
    assert np.abs(held.trace["x"] - undisturbed.trace["x"]).max() > 1e-4


def test_what_holds_the_robot_at_the_goal_is_planned_too() -> None:
    """The law's memory runs ahead with it: entered below the tolerance, left above twice that."""
    holding = {"law.goal_tolerance": 0.2, "law.omega_max": 1.7, "start": [-1.0, -1.0, 0.0]}
    undisturbed = run("fig6", SHORT, holding)
    planned = run(
        "fig6", SHORT, holding, {"link.plan": 150}, from_then_on({"outages": [[0.8, 1.2]]})
    )
    assert np.any((undisturbed.trace["v"][80:200] == 0) & (undisturbed.trace["omega"][80:200] != 0))
    same_poses(planned, undisturbed)


def test_what_limits_accelerations_is_planned_too() -> None:
    limits = {"law.accel_max": 1.0, "law.alpha_max": 2.0, "law.v_max": 1.0, "law.omega_max": 1.7}
    undisturbed = run("fig6", SHORT, limits)
    same_poses(run("fig6", SHORT, limits, LOSING, {"link.plan": 40}), undisturbed)


def test_neither_jitter_nor_loss_of_commands_changes_anything_while_measurements_pass() -> None:
    """What comes late is read from where it should be; n is what the plan is made for."""
    extra_delay = {"distribution": "exponential", "mean": 0.03}
    jitter = from_then_on({"extra_delay": extra_delay, "loss": 0.1})
    undisturbed = run("fig6", SHORT)
    planned = run("fig6", SHORT, jitter, {"link.plan": 60})
    same_poses(planned, undisturbed)
    assert planned.summary.station is not None
    assert planned.summary.station.n_seen > 10


def test_it_is_all_the_same_with_measurements_lost() -> None:
    lost = {"link.measurement.loss": 0.4, "link.measurement.outages": [[1.0, 0.5]]}
    same_poses(run("fig6", SHORT, LOSING, lost, {"link.plan": 60}), run("fig6", SHORT))


def test_commands_that_are_always_later_than_told_are_read_from_where_they_should_be() -> None:
    """With noise, too, the station believes that to be in force which is."""
    late = {"link.command.extra_delay": {"distribution": "constant", "mean": 0.05}}
    noisy = {"noise": True, "seed": 3}
    planned = run("lab", noisy, late, {"link.plan": 8})
    assert planned.summary.station is not None
    assert planned.summary.station.n_seen == 15
    told = run("lab", noisy, {"link.command_delay": 15})
    for axis in POSE:
        expected = rms_after_a_second(told, axis)
        assert rms_after_a_second(planned, axis) == pytest.approx(expected, rel=0.2), axis


def rms_after_a_second(run: Run, axis: str) -> float:
    error = run.trace[f"{axis}_est"] - run.trace[axis]
    return float(np.sqrt(np.mean(error[100:] ** 2)))


@pytest.mark.parametrize("scenario", ["fig4", "fig5", "fig6", "fig7", "fig8", "lab"])
def test_on_an_ideal_link_plans_change_no_byte(scenario: str) -> None:
    """In no column: what is sent is still the command, as if there were no plan behind it."""
    without, planned = (run(scenario, {"duration": 2.0, "link.plan": H}) for H in (0, 20))
    for column, values in without.trace.items():
        assert planned.trace[column].tobytes() == values.tobytes(), column


@pytest.mark.slow
def test_the_same_bytes_inline_over_udp_and_over_a_serial_pair_signed_or_not(
    laglab: Laglab, tmp_path: Path
) -> None:
    assert laglab("protocol", "keygen", "key").returncode == 0
    options = ("run", "lab-radio", "--set", "link.plan=40", "--duration", "3")
    traces = set()
    for transport, *key in (("inline",), ("udp", "--key", "key"), ("serial",)):
        result = laglab(*options, "--transport", transport, *key, "--out", transport)
        assert result.returncode == 0, result.stderr
        out = tmp_path / transport
        traces.add((out / "trace.csv").read_bytes() + (out / "link.csv").read_bytes())
    assert len(traces) == 1


def test_a_shadow_believes_what_the_station_believed() -> None:
    late = {"link.command.extra_delay": {"distribution": "constant", "mean": 0.05}}
    shadowed = {"noise": True, "estimator.kind": "delayed-ekf", "duration": 3.0}
    compared = {"estimator.compare": ["delayed-ekf"], "link.plan": 20}
    done = run("fig6", shadowed, compared, late, LOSING)
    assert done.summary.compare["delayed-ekf"] == done.summary.rms_error


def test_a_command_whose_plan_never_came_whole_has_no_delay() -> None:
    """It is given up long after."""
    done = run("fig6", {"link.plan": 60, "duration": 5.0}, LOSING)
    late = done.arrivals["refused"] == "incomplete"
    assert late.sum() > 50
    assert link_view(done).directions["command"].delay.max() == done.scenario.link.n
    told = io.StringIO()
    Console(file=told, width=120).print(results_table(done))
    assert re.search(r"arrived, 10.0 ticks late \(10 to 10\); \d+ frames lost *\n", told.getvalue())


@pytest.mark.parametrize("length", [-1, 241])
def test_a_plan_has_its_bounds(length: int) -> None:
    with pytest.raises(ScenarioError, match=r"link\.plan: must be"):
        laglab.load("fig6", {"link.plan": length})
