"""Runs over a bad radio: what the station's controller heard, and what it made of it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import laglab
from laglab_control import Control, Controller, Echo, InForce, Measured, StationConfig

SEEDS = (1, 2)
TICKS = 200
OLDEST = 60
"""Ticks; every measurement that comes is younger."""
RADIO = {
    "extra_delay": {"distribution": "exponential", "mean": 0.04},
    "loss": 0.1,
    "outages": [(1.0, 0.3)],
    "reorder": 0.05,
    "duplicate": 0.05,
}

Array = NDArray[np.float64]


class Heard(NamedTuple):
    """One tick: all that arrived, and the estimate and covariance with it."""

    arrived: Sequence[Measured]
    x: Array
    P: Array


@dataclass(frozen=True, eq=False)
class Overheard(Controller):
    """The station's controller, which keeps what it hears and says."""

    heard: list[Heard] = field(default_factory=list)

    def answer(
        self,
        control: Control,
        measurements: Sequence[Measured],
        echoes: Sequence[Echo] = (),
        recalled: Sequence[InForce] = (),
    ) -> Control:
        control = super().answer(control, measurements, echoes, recalled)
        self.heard.append(Heard(measurements, control.estimate.x, control.estimate.P))
        return control


class Apart(NamedTuple):
    """The largest distances between two estimates of a run, over all ticks."""

    position: float
    """[m]"""
    heading: float
    """[rad]"""
    deviations: float
    """Of x, in the standard deviations that the station claims."""
    covariance: float
    """Of P, in products of two of them."""


class Record(NamedTuple):
    """A run as an estimator gets it, and what the station said."""

    config: StationConfig
    """The model and the prior."""
    inputs: Array
    """(N, 2)."""
    heard: list[Heard]
    """N+1."""

    @property
    def arrivals(self) -> Iterator[dict[int, Array]]:
        """What is new at each tick: z by the tick it was sampled at."""
        seen: set[int] = set()
        for arrived, *_ in self.heard:
            new = {s: z for s, z in arrived if s not in seen}
            seen |= set(new)
            yield new

    def apart(self, x: Array, P: Array) -> Apart:
        """From another's x (N+1, 3) and P (N+1, 3, 3)."""
        said = np.array([heard.P for heard in self.heard])
        sigma = np.sqrt(np.diagonal(said, axis1=1, axis2=2))
        error = x - np.array([heard.x for heard in self.heard])
        error[:, 2] = np.angle(np.exp(1j * error[:, 2]))
        of_P = (P - said) / (sigma[:, :, np.newaxis] * sigma[:, np.newaxis, :])
        distances = error[:, :2], error[:, 2], error / sigma, of_P
        return Apart(*(float(np.abs(distance).max()) for distance in distances))


@cache
def recorded(seed: int, noise: float = 1.0) -> Record:
    """`lab` over the radio; `noise` scales the standard deviations of all that is random.

    The robot turns through a heading of pi, its sensor is surer of y than of x, and its wheels are
    noisy enough to count within so short a run.
    """
    made: list[Overheard] = []

    def overhear(config: StationConfig) -> Overheard:
        made.append(Overheard(config))
        return made[-1]

    overrides = {
        "start": (3.0, 1.0, 3.1),
        "duration": TICKS / 100,
        "seed": seed,
        "link.measurement": RADIO,
        "law.caution": 1.0,
        "estimator.initial_covariance": 1e-3 * noise**2,
        "plant.wheel_noise_variance": 1.0 * noise**2,
        "plant.measurement_variance": tuple(noise**2 * np.array([0.01, 0.004, 0.018])),
    }
    trace = laglab.run("lab", overrides, controller=overhear).trace
    inputs = np.stack([trace["v"], trace["omega"]], axis=1)[:-1]
    (controller,) = made
    return Record(controller.config, inputs, controller.heard)
