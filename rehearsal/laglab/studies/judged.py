"""What became of runs, one or many at once: the columns of a study."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.columns import beside
from laglab.results.nees import nees_by_triangle
from laglab.results.numbers import (
    COVARIANCE,
    RmsError,
    at_goal,
    goal_errors,
    last_second,
    loop_estimates,
    pose_difference,
    robot_pose,
)
from laglab.results.run import Run
from laglab.scenario import Target

Array = NDArray[np.float64]


class Stretch(NamedTuple):
    """What robots did for some ticks in a row, and what was believed of them. NaN from the tick on
    at which there is nothing any more, or where there is nothing yet."""

    truth: Array
    """(robots, ticks, 3), the pose [m, m, rad]."""
    estimates: Array | None
    """(robots, ticks, 3), x̂_k of the estimator in the loop; None: it estimates nothing."""
    claimed: Array | None
    """(robots, ticks, 6), of the covariance that the station claims for it the upper triangle;
    None: nothing."""
    applied: Array
    """(robots, ticks, 2), the speeds v, ω in force on [t_k, t_{k+1}) [m/s, rad/s]."""


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
    alarm_s: Array
    """[s] When the guard raised its first alarm."""
    alarm_error: Array
    """[m] Of the estimated position, LOOKED_AT_AFTER later, if the run goes on until then."""


ALARMS = ("alarm_s", "alarm_error")
"""What a study's rows have only where it is asked for."""
LOOKED_AT_AFTER = 2.0
"""[s] How long after the first alarm the error is looked at."""


class Judge:
    """Judges runs by their ticks as they come; what is kept does not grow with them."""

    def __init__(self, of: Target, measurement_delay: int, robots: int) -> None:
        self._of = of
        self._measurement_delay = measurement_delay
        self._ticks = 0
        self._last_pose = np.full((robots, 3), np.nan)
        self._away = np.full(robots, -1)
        """The last tick at which it was elsewhere than where it ought to be."""
        self._rms = RmsError()
        self._nees, self._claims = np.zeros(robots), np.zeros(robots)
        """The sum of NEES, and over how many ticks."""
        self._largest = np.full((robots, 2), np.nan)

    def add(self, stretch: Stretch) -> None:
        """The next ticks."""
        truth, estimates, claimed, applied = stretch
        ticks = np.arange(self._ticks, self._ticks + truth.shape[1])
        there = at_goal(truth, self._of.poses(ticks.astype(np.float64)))
        away = np.where(there, -1, ticks).max(axis=1)
        self._away = np.maximum(self._away, away)
        recorded = np.count_nonzero(~np.isnan(truth[..., 0]), axis=1)
        some = np.flatnonzero(recorded)
        self._last_pose[some] = truth[some, recorded[some] - 1]
        largest = np.fmax.reduce(np.abs(applied), axis=1)
        self._largest = np.fmax(self._largest, largest)
        if estimates is not None:
            late = slice(max(self._measurement_delay - self._ticks, 0), None)
            self._compare(truth[:, late], estimates[:, late], claimed, late)
        self._ticks += len(ticks)

    def _compare(self, truth: Array, estimates: Array, claimed: Array | None, late: slice) -> None:
        error = pose_difference(estimates, truth)
        self._rms.add(error)
        if claimed is not None:
            values = nees_by_triangle(error, claimed[:, late])
            missing = np.isnan(values)
            with np.errstate(over="ignore"):
                self._nees += np.where(missing, 0.0, values).sum(axis=1)
            self._claims += (~missing).sum(axis=1)

    def judgements(self, diverged: Array) -> Judgements:
        """Of every robot. `diverged` (robots,): the tick at which its run ended because the
        estimate had diverged; NaN: it went on to its last tick. There was no alarm."""
        last, sample_time = self._ticks - 1, self._of.sample_time
        completed = np.isnan(diverged)
        time: Array = np.arange(self._ticks) * np.float64(sample_time)
        settled = np.where(completed & (self._away < last), self._away + 1, np.nan)
        ended = np.where(completed, last, diverged)
        rho, theta_error = goal_errors(self._last_pose, self._of.poses(ended))
        rms = np.array(np.broadcast_to(self._rms.values(), self._last_pose.shape))
        with np.errstate(invalid="ignore"):
            mean_nees = self._nees / self._claims
        return Judgements(
            converged=completed & (self._away < np.argmax(last_second(time))),
            settled_s=settled * sample_time,
            rms_x=rms[:, 0],
            rms_y=rms[:, 1],
            rms_theta=rms[:, 2],
            nees=mean_nees,
            final_rho=rho,
            final_theta_error=theta_error,
            max_v=self._largest[:, 0],
            max_omega=self._largest[:, 1],
            diverged_tick=diverged,
            alarm_s=np.full(len(diverged), np.nan),
            alarm_error=np.full(len(diverged), np.nan),
        )


def judgements(record: Stretch, diverged: Array, of: Target, measurement_delay: int) -> Judgements:
    """Of runs that are there from their first tick to their last."""
    judge = Judge(of, measurement_delay, len(record.truth))
    judge.add(record)
    return judge.judgements(diverged)


def judged_run(done: Run) -> Judgements:
    """Of one run."""
    trace, diverged = done.trace, done.summary.outcome == "diverged"
    claimed = beside(trace["tick"], done.claims, "tick", COVARIANCE)
    record = Stretch(
        robot_pose(trace)[np.newaxis],
        loop_estimates(trace)[np.newaxis],
        np.stack(list(claimed.values()), axis=1)[np.newaxis],
        np.stack([trace["v"], trace["omega"]], axis=1)[np.newaxis],
    )
    last = np.array([trace["tick"][-1] if diverged else np.nan])
    judged = judgements(record, last, done.scenario.target, done.scenario.link.m)
    if not done.alarms:
        return judged
    Ts = done.scenario.sample_time
    later = done.alarms[0] + round(LOOKED_AT_AFTER / Ts)
    off = pose_difference(loop_estimates(trace), robot_pose(trace))[later : later + 1, :2]
    error = np.hypot(*off.T) if len(off) else np.array([np.nan])
    return judged._replace(alarm_s=np.array([done.alarms[0] * Ts]), alarm_error=error)


def joined(parts: list[Judgements]) -> Judgements:
    """All of them, one after the other."""
    return Judgements(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
