"""What became of runs, one or many at once: the columns of a study."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.nees import nees
from laglab.results.numbers import (
    RmsError,
    at_goal,
    goal_errors,
    last_second,
    loop_estimates,
    mean_of_known,
    pose_difference,
    robot_pose,
)
from laglab.results.run import Run
from laglab.scenario import Target

Array = NDArray[np.float64]
AT_ONCE = 8
"""Robots: so many stay within a processor's cache."""


class Record(NamedTuple):
    """What robots did, and what was believed of them. NaN from the tick on at which there is
    nothing any more, or where there is nothing yet."""

    truth: Array
    """(robots, ticks, 3), the pose [m, m, rad]."""
    estimates: Array | None
    """(robots, ticks, 3), x̂_k of the estimator in the loop; None: it estimates nothing."""
    claimed: Array | None
    """(robots, ticks, 3, 3), the covariance that the station claims for it; None: nothing."""
    applied: Array
    """(robots, ticks, 2), the speeds v, ω in force on [t_k, t_{k+1}) [m/s, rad/s]."""
    diverged: Array
    """(robots,), the tick at which the run ended because the estimate had diverged; NaN: it went
    on to its last tick."""


def record_of(done: Run, claimed: Array | None = None) -> Record:
    """Of one robot, with what its station claimed (ticks, 3, 3)."""
    trace, diverged = done.trace, done.summary.outcome == "diverged"
    return Record(
        robot_pose(trace)[np.newaxis],
        loop_estimates(trace)[np.newaxis],
        None if claimed is None else claimed[np.newaxis],
        np.stack([trace["v"], trace["omega"]], axis=1)[np.newaxis],
        np.array([trace["tick"][-1] if diverged else np.nan]),
    )


class Judgements(NamedTuple):
    """A column each, shape (robots,); NaN for nothing. SI units."""

    converged: NDArray[np.bool_]
    """At the goal, or where the path wants it, at every tick of the last second."""
    settled_s: Array
    """[s] From when on it was there, to the end."""
    rms_x: Array
    rms_y: Array
    rms_theta: Array
    """Of the estimate's error over the ticks >= m."""
    nees: Array
    """Averaged over the ticks >= m at which the covariance is one."""
    final_rho: Array
    final_theta_error: Array
    max_v: Array
    max_omega: Array
    """The largest applied, absolute."""
    diverged_tick: Array


def judgements(record: Record, of: Target, measurement_delay: int) -> Judgements:
    """Of every robot. Needs little memory beside the record itself."""
    judged = [_of(part, of, measurement_delay) for part in _parts(record)]
    return joined(judged)


def joined(parts: list[Judgements]) -> Judgements:
    """All of them, one after the other."""
    return Judgements(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _parts(record: Record) -> Iterator[Record]:
    for first in range(0, len(record.truth), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        yield Record(*(None if each is None else each[some] for each in record))  # type: ignore[arg-type]


def _of(record: Record, of: Target, m: int) -> Judgements:
    truth, estimates, claimed, applied, diverged = record
    (robots, ticks, _), sample_time = truth.shape, of.sample_time
    wanted = of.poses(np.arange(float(ticks)))
    there = at_goal(truth, wanted)
    completed = np.isnan(diverged)
    time: Array = np.arange(ticks) * np.float64(sample_time)
    last = np.where(completed, ticks - 1, np.nan_to_num(diverged)).astype(int)
    rho, theta_error = goal_errors(truth[np.arange(robots), last], wanted[last])
    rms, mean_nees = _of_estimates(truth, estimates, claimed, m)
    largest = np.fmax.reduce(np.abs(applied), axis=1)
    return Judgements(
        converged=completed & there[:, last_second(time)].all(axis=1),
        settled_s=np.where(completed, _settled(there) * sample_time, np.nan),
        rms_x=rms[:, 0],
        rms_y=rms[:, 1],
        rms_theta=rms[:, 2],
        nees=mean_nees,
        final_rho=rho,
        final_theta_error=theta_error,
        max_v=largest[:, 0],
        max_omega=largest[:, 1],
        diverged_tick=diverged,
    )


def _settled(there: NDArray[np.bool_]) -> Array:
    """The first tick from which it holds to the end; NaN when it does not."""
    ticks = there.shape[1]
    away = ticks - np.argmax(~there[:, ::-1], axis=1)  # one after the last tick elsewhere
    first = np.where(there.all(axis=1), 0, away)
    return np.where(there[:, -1], first, np.nan)


def _of_estimates(
    truth: Array, estimates: Array | None, claimed: Array | None, m: int
) -> tuple[Array, Array]:
    nothing = np.full((len(truth), 3), np.nan)
    if estimates is None:
        return nothing, nothing[:, 0]
    error = pose_difference(estimates[:, m:], truth[:, m:])
    rms = RmsError()
    rms.add(error)
    return rms.values(), nothing if claimed is None else mean_of_known(
        nees(error, claimed[:, m:]), axis=1
    )
