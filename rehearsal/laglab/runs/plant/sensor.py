"""The sensor of a plant that has none of its own."""

from collections.abc import Sequence

import numpy as np

from laglab.scenario import Scenario

STREAM = 2
"""Of a seed's generators, that of the measurements."""


class NoisySensor:
    """z = x + v, v normal with the scenario's variances; without noise, z = x."""

    def __init__(self, scenario: Scenario) -> None:
        """With tick 0 drawn."""
        self._rng = np.random.default_rng((scenario.seed, STREAM))
        variance = scenario.plant.measurement_variance
        self._deviation = np.sqrt(variance) if scenario.noise else np.zeros(3)
        self.draw()

    def draw(self) -> None:
        """The next tick's noise: three numbers a tick, whatever is made of them."""
        self._noise = (self._deviation * self._rng.standard_normal(3)).tolist()

    def sample(self, pose: Sequence[float]) -> tuple[float, float, float]:
        """What it says at this tick of a pose x, y, θ [m, m, rad]."""
        x, y, theta = (each + noise for each, noise in zip(pose, self._noise, strict=True))
        return x, y, theta
