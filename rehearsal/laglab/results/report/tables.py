"""What a page draws: the columns behind its plots, of a whole run or of a piece of one."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.columns import Columns, beside
from laglab.results.numbers import (
    AXES,
    VARIANCES,
    deviation,
    goal_errors,
    loop_estimates,
    robot_pose,
    shadow_estimates,
)
from laglab.scenario import Target
from laglab_gateway import FOLLOWED, FateKind, Trace

Array = NDArray[np.float64]

ALARM, STOPPED, REFUSED = "alarms", "stops", "refused"
COMMAND_LOST, MEASUREMENT_LOST = "commands", "measurements"
LANES = (MEASUREMENT_LOST, COMMAND_LOST, REFUSED, STOPPED, ALARM)
"""What is marked below the delays, from below."""
BY_ITSELF, EMERGENCY = "by itself", "emergency stop"

COVARIANCES = ("p_xx", "p_xy", "p_yy", "p_tt")


class Tables(NamedTuple):
    """Time in s from the run's first tick, delays in ticks, all else in SI units."""

    ticks: Columns
    """A row a tick: the robot, its estimate and the command."""
    commands: Columns
    """A row for each that came: when, its stamp and how late."""
    measurements: Columns
    marks: Columns
    """What went wrong: when, in which lane, and what it was."""
    timing: Columns
    """How late each tick on the wall clock began [ms]."""


def tick_columns(
    trace: Trace, claims: Columns, target: Target, shadows: Sequence[str] = ()
) -> dict[str, Array]:
    """Of each tick: poses, errors (with twice the claimed deviations), speeds and distances."""
    pose, rows = robot_pose(trace), len(trace["tick"])
    rho, heading_error = goal_errors(pose, target.poses(trace["tick"]))
    columns = {"tick": trace["tick"], "time": trace["time"], "rho": rho, "turn": heading_error}
    columns |= dict(zip(AXES, pose.T, strict=True))
    for name in AXES:
        columns |= {f"{name}_{of}": trace[f"{name}_{of}"] for of in ("est", "meas")}
    columns |= {name: trace[name] for name in ("v_sent", "omega_sent", "v", "omega")}
    columns |= _errors("", deviation(trace, loop_estimates(trace)))
    for name in shadows:
        columns |= _errors(f"_{name}", deviation(trace, shadow_estimates(trace, name)))
    columns |= beside(trace["time"], claims, "time", COVARIANCES)
    for axis, variance in zip(AXES, VARIANCES, strict=True):
        within = 2 * np.sqrt(np.maximum(columns[variance], 0.0))
        columns |= {f"{axis}_above": within, f"{axis}_below": -within}
    columns["due"] = np.full(rows, np.nan)
    return columns


def _errors(suffix: str, off: Array) -> dict[str, Array]:
    return {f"{axis}_error{suffix}": off[:, i] for i, axis in enumerate(AXES)}


def arrival_columns(arrivals: Columns, direction: str) -> Columns:
    """Of those of one direction that were followed or heard: when, which, and how late [ticks]."""
    of = (arrivals["direction"] == direction) & (arrivals["refused"] == FOLLOWED)
    stamp, arrived = arrivals["tick"][of].astype(float), arrivals["arrived"][of].astype(float)
    return {"time": arrivals["time"][of], "tick": stamp, "due": arrived, "delay": arrived - stamp}


def refusals(arrivals: Columns) -> Columns:
    """As marks."""
    of = arrivals["refused"] != FOLLOWED
    return marks(arrivals["time"][of], REFUSED, arrivals["refused"][of])


def losses(link: Columns, sample_time: float) -> Columns:
    """As marks: each copy of a frame that did not come through, and why."""
    lost = link["fate"] != FateKind.DELIVERED
    lanes = np.where(link["direction"][lost] == "command", COMMAND_LOST, MEASUREMENT_LOST)
    time = link["tick"][lost].astype(float) * sample_time
    return {"time": time, "lane": lanes, "what": link["fate"][lost]}


def timing_columns(timing: Columns, sample_time: float) -> Columns:
    """When each tick was due [s], and how late it began [ms]."""
    late = timing["lateness"].astype(float) * 1e3
    return {"time": timing["tick"].astype(float) * sample_time, "late": late}


def marks(times: Sequence[float] | Array, lane: str, what: str | Sequence[str] | Array) -> Columns:
    """Several in one lane."""
    rows = len(times)
    texts = [what] * rows if isinstance(what, str) else list(what)
    return {
        "time": np.asarray(times, dtype=float),
        "lane": np.full(rows, lane, dtype=object),
        "what": np.array(texts, dtype=object),
    }
