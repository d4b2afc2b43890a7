"""The verdict on a run, from its trace."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from laglab.results.pose import is_measured, robot_pose
from laglab.run.rehearse import Ending, Transport
from laglab.scenario import Scenario
from laglab_control.angle import wrap
from laglab_gateway import Trace
from laglab_protocol import EndReason

SUMMARY_FILE = "summary.json"
DISTANCE_BOUND = 0.06
HEADING_BOUND = 0.05

Errors = dict[str, float]


_wrapped = np.vectorize(wrap, otypes=[np.float64])


def goal_errors(
    pose: NDArray[np.float64], scenario: Scenario
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance to the goal ρ [m] and heading error [rad] of poses, shape (n, 3)."""
    x, y, theta = scenario.goal
    rho = np.hypot(pose[:, 0] - x, pose[:, 1] - y)
    return rho, _wrapped(pose[:, 2] - theta)


def has_converged(trace: Trace, scenario: Scenario) -> bool:
    """ρ < 0.06 m and |θ error| < 0.05 rad at every tick of the last second.

    Where the pose is measured, in the second's mean: the sensor's noise does not move the robot.
    """
    last_second = robot_pose(trace)[trace["time"] >= trace["time"][-1] - 1.0]
    if is_measured(trace):
        last_second = np.nanmean(last_second, axis=0, keepdims=True)
    rho, theta_error = goal_errors(last_second, scenario)
    return bool(((rho < DISTANCE_BOUND) & (np.abs(theta_error) < HEADING_BOUND)).all())


def deviation(trace: Trace, estimates: NDArray[np.float64]) -> NDArray[np.float64]:
    """Estimate less pose, shape (ticks + 1, 3), heading wrapped."""
    difference = estimates - robot_pose(trace)
    difference[:, 2] = _wrapped(difference[:, 2])
    return difference


def loop_estimates(trace: Trace) -> NDArray[np.float64]:
    """x̂_k of the estimator in the loop, shape (ticks + 1, 3)."""
    return np.stack([trace["x_est"], trace["y_est"], trace["theta_est"]], axis=1)


def rms_error(deviations: NDArray[np.float64], measurement_delay: int) -> Errors | None:
    """Root mean square over the ticks ≥ m with an estimate; None where there is none."""
    settled = deviations[measurement_delay:]
    if not len(settled) or np.isnan(settled).all():
        return None
    with np.errstate(over="ignore"):
        values = np.sqrt(np.nanmean(settled**2, axis=0))
    return dict(zip(("x", "y", "theta"), values.tolist(), strict=True))


def summarise(
    scenario: Scenario, transport: Transport, ending: Ending, trace: Trace
) -> dict[str, Any]:
    """The contents of ``summary.json``; values that are not finite become null."""
    rho, theta_error = goal_errors(robot_pose(trace), scenario)
    completed = ending.outcome is not None and ending.outcome.reason is EndReason.COMPLETED
    ticks = int(trace["tick"][-1] - trace["tick"][0])
    simulated = ticks * scenario.sample_time
    summary = {
        "scenario": scenario.name,
        "estimator": scenario.estimator.kind,
        "n": scenario.link.command_delay,
        "m": scenario.link.measurement_delay,
        "seed": scenario.seed,
        "transport": transport,
        "ticks": ticks,
        "pose": "measured" if is_measured(trace) else "true",
        "final": {
            "rho": float(rho[-1]),
            "theta_error": float(theta_error[-1]),
            "v": float(trace["v"][-1]),
            "omega": float(trace["omega"][-1]),
        },
        "rms_error": rms_error(
            deviation(trace, loop_estimates(trace)), scenario.link.measurement_delay
        ),
        "converged": completed and has_converged(trace, scenario),
        "wall_time_s": ending.loop_seconds,
        "real_time_factor": simulated / ending.loop_seconds if ending.loop_seconds else None,
        **ending.statistics,
    }
    summary["verdict"] = _verdict(ending, summary)
    return summary


def _verdict(ending: Ending, summary: dict[str, Any]) -> str:
    if ending.outcome is None:
        return f"cut short at tick {summary['ticks']}: {ending.problem}"
    tick = ending.outcome.tick
    match ending.outcome.reason:
        case EndReason.DIVERGED:
            return (
                f"stopped at tick {tick}: the estimate diverged "
                "(not finite, or beyond 1 km of both start and goal)"
            )
        case EndReason.INTERRUPTED:
            return f"interrupted at tick {tick}"
        case EndReason.FAILED:
            return f"stopped at tick {tick}: the controller failed"
    final = summary["final"]
    word = "converged" if summary["converged"] else "did not converge"
    seen = " as measured" if summary["pose"] == "measured" else ""
    return (
        f"{word}: at the end ρ = {final['rho']:.3g} m, "
        f"θ error = {final['theta_error']:.3g} rad{seen}"
    )


def write_summary(summary: dict[str, Any], directory: Path) -> None:
    """Keep the summary beside the trace."""
    text = json.dumps(_finite(summary), indent=2, ensure_ascii=False)
    (directory / SUMMARY_FILE).write_text(text + "\n", encoding="utf-8")


def _finite(value: Any) -> Any:
    """JSON has no NaN and no infinity: they become null."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return None if isinstance(value, float) and not np.isfinite(value) else value
