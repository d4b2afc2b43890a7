"""Taking over a robot in the middle of its way: where is it, when nobody remembers?

A station that starts again knows neither the pose nor the commands on their way. So it commands
standstill, and when the robot's echoes say that it stands, it averages the measured poses. What is
in flight is then known too: nothing but standstill.
"""

from typing import NamedTuple

import numpy as np

from laglab_control import Matrix, RobotModel, Vector
from laglab_protocol import Measurement

SAMPLES = 100
"""Measured poses to average: the covariance of the mean is R / SAMPLES."""


class Rest(NamedTuple):
    """A robot that has stood still for `samples` measurements, the newest sampled at `tick`."""

    samples: int = 0
    tick: int = -1
    mean: Vector = np.zeros(3)

    @property
    def known(self) -> bool:
        """Whether the mean is good enough to start from."""
        return self.samples >= SAMPLES


def observe(rest: Rest, measurement: Measurement, model: RobotModel) -> Rest:
    """With one more measurement; if the robot still moved at its sampling, all begins again."""
    if measurement.tick <= rest.tick:
        return rest
    if measurement.v != 0 or measurement.omega != 0:
        return Rest(tick=measurement.tick)
    z, samples = np.array(measurement.pose), rest.samples + 1
    mean = z if samples == 1 else rest.mean + model.innovation(z, rest.mean) / samples
    return Rest(samples, measurement.tick, mean)


def prior(rest: Rest, model: RobotModel) -> tuple[Vector, Matrix]:
    """The estimate x (3,) and P (3, 3) at the tick of the newest measurement in the mean."""
    return rest.mean, model.R / rest.samples
