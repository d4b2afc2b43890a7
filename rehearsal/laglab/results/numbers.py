"""Numbers from traces: where the robot was, how far the estimate was off, whether it got there."""

import numpy as np
from numpy.typing import NDArray

from laglab.results.summary import Errors
from laglab_control import wrapped
from laglab_gateway import Trace

AXES = ("x", "y", "theta")
VARIANCES = ("p_xx", "p_yy", "p_tt")
"""The variances of these, as tables call them."""
COVARIANCE = ("p_xx", "p_xy", "p_xt", "p_yy", "p_yt", "p_tt")
"""The upper triangle of their covariance."""
DISTANCE_BOUND = 0.06
HEADING_BOUND = 0.05
LAST_SECOND = 1.0
Array = NDArray[np.float64]
Goal = tuple[float, float, float] | Array
"""x [m], y [m], theta [rad]; or such a pose for each, shape (..., 3)."""


def is_measured(trace: Trace) -> bool:
    """Whether the true pose is unknown."""
    return bool(np.isnan(trace["x"]).all())


def robot_pose(trace: Trace) -> Array:
    """The true pose at every tick, or else the measured one, shape (ticks + 1, 3) [m, m, rad]."""
    suffix = "_meas" if is_measured(trace) else ""
    return np.stack([trace[axis + suffix] for axis in AXES], axis=1)


def measurements(trace: Trace) -> Array:
    """z_k as sampled, shape (ticks + 1, 3) [m, m, rad]."""
    return np.stack([trace[f"{axis}_meas"] for axis in AXES], axis=1)


def loop_estimates(trace: Trace) -> Array:
    """x̂_k of the estimator in the loop, shape (ticks + 1, 3) [m, m, rad]."""
    return np.stack([trace[f"{axis}_est"] for axis in AXES], axis=1)


def shadow_estimates(trace: Trace, name: str) -> Array:
    """x̂_k of an estimator that shadowed the loop, shape (ticks + 1, 3) [m, m, rad]."""
    return np.stack([trace[f"{axis}_{name}"] for axis in AXES], axis=1)


def deviation(trace: Trace, estimates: Array) -> Array:
    """Estimate less pose, shape (ticks + 1, 3) [m, m, rad], heading wrapped."""
    return pose_difference(estimates, robot_pose(trace))


def pose_difference(poses: Array, others: Array) -> Array:
    """Poses less others, shape (..., 3) [m, m, rad], heading wrapped."""
    with np.errstate(invalid="ignore"):
        difference = poses - others
    difference[..., 2] = wrapped(difference[..., 2])
    return difference


def mean_of_known(values: Array) -> Array:
    """Along the first axis; NaN where there is no value."""
    there = ~np.isnan(values)
    with np.errstate(invalid="ignore", over="ignore"):
        mean: Array = np.where(there, values, 0).sum(axis=0) / there.sum(axis=0)
    return mean


def goal_errors(pose: Array, goal: Goal) -> tuple[Array, Array]:
    """Distance to the goal ρ [m] and heading error [rad] of poses, shape (..., 3)."""
    off = pose - np.asarray(goal)
    return np.hypot(off[..., 0], off[..., 1]), wrapped(off[..., 2])


def at_goal(pose: Array, goal: Goal) -> NDArray[np.bool_]:
    """ρ < 0.06 m and |θ error| < 0.05 rad, of poses (..., 3)."""
    rho, theta_error = goal_errors(pose, goal)
    within: NDArray[np.bool_] = (rho < DISTANCE_BOUND) & (np.abs(theta_error) < HEADING_BOUND)
    return within


def last_second(time: Array) -> NDArray[np.bool_]:
    """Which of the times [s] lie in the last one."""
    there: NDArray[np.bool_] = time >= time[-1] - LAST_SECOND
    return there


def has_converged(trace: Trace, goal: Goal) -> bool:
    """Whether it was at the goal at every tick of the last second."""
    off = off_in_the_end(trace, goal)
    return len(off) > 0 and bool(at_goal(off, (0.0, 0.0, 0.0)).all())


def off_in_the_end(trace: Trace, goal: Goal) -> Array:
    """(ticks, 3), pose less goal at the ticks of the last second [m, m, rad].

    Where the pose is measured, the second's mean alone: the sensor's noise does not move the robot.
    """
    off = pose_difference(robot_pose(trace), np.asarray(goal))[last_second(trace["time"])]
    if not is_measured(trace):
        return off
    off = off[~np.isnan(off).any(axis=1)]
    if not len(off):
        return off
    off[:, 2] = off[0, 2] + wrapped(off[:, 2] - off[0, 2])  # or who stands backwards is at 0
    mean: Array = off.mean(axis=0, keepdims=True)
    mean[:, 2] = wrapped(mean[:, 2])
    return mean


class RmsError:
    """Root mean square over any number of deviations (..., n, 3), piece by piece, of as many
    robots at once as there are in the axes before; NaN: none there."""

    def __init__(self) -> None:
        self._squares: Array = np.zeros(3)
        self._count: NDArray[np.intp] | int = 0

    def add(self, deviations: Array) -> None:
        """Some more."""
        x, y, theta = np.moveaxis(np.isnan(deviations), -1, 0)
        there = ~(x | y | theta)
        known = np.where(there[..., np.newaxis], deviations, 0.0)
        with np.errstate(over="ignore"):
            self._squares = self._squares + np.einsum("...kj,...kj->...j", known, known)
        self._count = self._count + np.count_nonzero(there, axis=-1)

    def values(self) -> Array:
        """Shape (..., 3); NaN without any; the largest number there is where it is infinite."""
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = self._squares / np.asarray(self._count)[..., np.newaxis]
        rms: Array = np.nan_to_num(np.sqrt(mean), nan=np.nan)  # JSON has no infinity
        return rms

    def errors(self) -> Errors | None:
        """Of one robot; None without any."""
        rms = self.values()
        return None if np.isnan(rms).any() else Errors(*rms.tolist())


def rms_error(deviations: Array) -> Errors | None:
    """Root mean square of all of them at once."""
    rms = RmsError()
    rms.add(deviations)
    return rms.errors()
