"""A drive of the model's own robot, for estimators to be tried on."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control import Measured, RobotModel

Array = NDArray[np.float64]
P_0 = 1e-3
"""[m², m², rad²] The variance of the start that an estimator is told."""


class Record(NamedTuple):
    """N ticks."""

    poses: Array
    """(N+1, 3)."""
    inputs: Array
    """(N, 2): row k was in force on [t_k, t_{k+1})."""
    measurements: Array
    """(N+1, 3)."""
    x: Array
    """(3,): the start that an estimator is told."""

    @property
    def P(self) -> Array:
        """Its covariance (3, 3)."""
        return P_0 * np.eye(3)

    def measured(self, tick: int) -> Measured:
        """The measurement sampled at that tick."""
        return Measured(tick, self.measurements[tick].copy())


def drive(model: RobotModel, ticks: int, seed: int, noise: bool = True) -> Record:
    """Along bends, with the noise that the model claims; without it all is known exactly."""
    random = np.random.default_rng((seed, 7))
    scale = 1.0 if noise else 0.0
    time = model.sample_time * np.arange(ticks)
    inputs = np.stack((0.5 + 0.2 * np.sin(time), 0.8 * np.sin(0.7 * time + seed)), axis=1)
    poses = np.empty((ticks + 1, 3))
    poses[0] = random.uniform(-1, 1, 3)
    r, track = model.wheel_radius, model.track
    wheels = scale * random.standard_normal((ticks, 2)) * np.sqrt(np.diag(model.Q))
    for k, (u, (left, right)) in enumerate(zip(inputs, wheels, strict=True)):
        slipping = u + np.array((r * (left + right) / 2, r * (right - left) / track))
        poses[k + 1] = model.f(poses[k], slipping)
    sensed = scale * random.standard_normal((ticks + 1, 3)) * np.sqrt(np.diag(model.R))
    off = scale * random.standard_normal(3) * np.sqrt(P_0)
    return Record(poses, inputs, poses + sensed, poses[0] + off)
