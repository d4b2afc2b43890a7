"""Numbers from traces: where the robot was, how far the estimate was off, whether it got there."""

import numpy as np
from numpy.typing import NDArray

from laglab.results.summary import Errors
from laglab_control import wrap
from laglab_gateway import Trace

AXES = ("x", "y", "theta")
DISTANCE_BOUND = 0.06
HEADING_BOUND = 0.05
LAST_SECOND = 1.0
Array = NDArray[np.float64]

_wrapped = np.vectorize(wrap, otypes=[np.float64])


def is_measured(trace: Trace) -> bool:
    """Whether the true pose is unknown."""
    return bool(np.isnan(trace["x"]).all())


def robot_pose(trace: Trace) -> Array:
    """The true pose at every tick, or else the measured one, shape (ticks + 1, 3) [m, m, rad]."""
    suffix = "_meas" if is_measured(trace) else ""
    return np.stack([trace[axis + suffix] for axis in AXES], axis=1)


def measurements(trace: Trace) -> Array:
    """z_k as sampled, shape (ticks + 1, 3)."""
    return np.stack([trace[f"{axis}_meas"] for axis in AXES], axis=1)


def loop_estimates(trace: Trace) -> Array:
    """x̂_k of the estimator in the loop, shape (ticks + 1, 3)."""
    return np.stack([trace[f"{axis}_est"] for axis in AXES], axis=1)


def shadow_estimates(trace: Trace, name: str) -> Array:
    """x̂_k of an estimator that shadowed the loop, shape (ticks + 1, 3)."""
    return np.stack([trace[f"{axis}_{name}"] for axis in AXES], axis=1)


def deviation(trace: Trace, estimates: Array) -> Array:
    """Estimate less pose, shape (ticks + 1, 3), heading wrapped."""
    difference = estimates - robot_pose(trace)
    difference[:, 2] = _wrapped(difference[:, 2])
    return difference


def goal_errors(pose: Array, goal: tuple[float, float, float]) -> tuple[Array, Array]:
    """Distance to the goal ρ [m] and heading error [rad] of poses, shape (n, 3)."""
    x, y, theta = goal
    rho = np.hypot(pose[:, 0] - x, pose[:, 1] - y)
    return rho, _wrapped(pose[:, 2] - theta)


def has_converged(trace: Trace, goal: tuple[float, float, float]) -> bool:
    """ρ < 0.06 m and |θ error| < 0.05 rad at every tick of the last second.

    Where the pose is measured, in the second's mean: the sensor's noise does not move the robot.
    """
    last_second = robot_pose(trace)[trace["time"] >= trace["time"][-1] - LAST_SECOND]
    if is_measured(trace):
        last_second = last_second[~np.isnan(last_second).any(axis=1)]
        last_second = last_second.mean(axis=0, keepdims=True) if len(last_second) else last_second
    rho, theta_error = goal_errors(last_second, goal)
    within = (rho < DISTANCE_BOUND) & (np.abs(theta_error) < HEADING_BOUND)
    return bool(len(within) and within.all())


class RmsError:
    """Root mean square over any number of deviations (n, 3), piece by piece; NaN: none there."""

    def __init__(self) -> None:
        self._squares = np.zeros(3)
        self._count = 0

    def add(self, deviations: Array) -> None:
        """Some more."""
        there = deviations[~np.isnan(deviations).any(axis=1)]
        with np.errstate(over="ignore"):
            self._squares = self._squares + (there**2).sum(axis=0)
        self._count += len(there)

    def errors(self) -> Errors | None:
        """None without any, or when they are not finite."""
        if not self._count:
            return None
        rms = np.nan_to_num(np.sqrt(self._squares / self._count))  # JSON has no infinity
        return Errors(*rms.tolist())


def rms_error(deviations: Array) -> Errors | None:
    """Root mean square of all of them at once."""
    rms = RmsError()
    rms.add(deviations)
    return rms.errors()
