"""The loop of docs/tick.md in plain numpy: an independent plant for the controller to drive."""

from collections import deque
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pytest
from numpy.typing import NDArray

from laglab_control import Controller, Measured, SpeedLimits, StationConfig

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """Ticks 0 ... N: poses, measurements, estimates (N+1, 3); inputs applied (N, 2).

    NaN after the estimate has gone beyond 1 km.
    """

    poses: Array
    measurements: Array
    estimates: Array
    inputs: Array
    m: int

    def rms_error(self) -> Array:
        """Of the estimate over ticks >= m, per component."""
        error = (self.estimates - self.poses)[self.m :]
        error[:, 2] = np.angle(np.exp(1j * error[:, 2]))
        return np.sqrt(np.mean(error**2, axis=0))

    def converged(self) -> bool:
        """rho < 0.06 m and |theta| < 0.05 rad throughout the last second; the goal is 0."""
        last = self.poses[-101:]
        heading = np.angle(np.exp(1j * last[:, 2]))
        near = np.hypot(last[:, 0], last[:, 1]) < 0.06
        return bool(np.all(near) and np.all(np.abs(heading) < 0.05))


class Simulate(Protocol):
    """The fixture's type."""

    def __call__(
        self,
        estimator: str,
        *,
        start: tuple[float, float, float] = ...,
        n: int = ...,
        m: int = ...,
        p0: float = ...,
        limits: SpeedLimits = ...,
        noise: int | None = ...,
        x0: Array | None = ...,
        ticks: int = ...,
    ) -> Record: ...


@pytest.fixture
def simulate() -> Simulate:
    """Runs one loop; `noise` is a seed, None for no noise."""
    return _simulate


def _simulate(
    estimator: str,
    *,
    start: tuple[float, float, float] = (-3.0, -3.0, 0.0),
    n: int = 10,
    m: int = 20,
    p0: float = 1e-4,
    limits: SpeedLimits = SpeedLimits(),  # noqa: B008 frozen
    noise: int | None = None,
    x0: Array | None = None,
    ticks: int = 1000,
) -> Record:
    config = StationConfig(
        estimator=estimator,
        limits=limits,
        initial_estimate=start if x0 is None else x0,
        initial_covariance=np.eye(3) * p0,
        command_delay=n,
    )
    random = None if noise is None else np.random.default_rng(noise)
    controller = Controller(config)
    control = controller.start()
    poses, measurements, estimates = np.full((3, ticks + 1, 3), np.nan)
    inputs = np.full((ticks, 2), np.nan)
    x = np.array(start)
    due = deque(np.zeros((n, 2)))
    for k in range(ticks + 1):
        poses[k] = x
        measurements[k] = (
            x if random is None else x + random.normal(size=3) * np.sqrt([0.01, 0.01, 0.018])
        )
        if k > 0:
            control = controller.advance(control)
        arrived = [Measured(k - m, measurements[k - m])] if k >= m else []
        control = controller.answer(control, arrived)
        if control.estimate.x is not None:
            estimates[k] = control.estimate.x
            if np.hypot(*estimates[k, :2]) > 1000:
                break
        if k == ticks:
            break
        due.append(np.array(control.drive[:2]))
        inputs[k] = due.popleft()
        x = _plant(x, inputs[k], random)
    return Record(poses, measurements, estimates, inputs, m)


def _plant(x: Array, u: Array, random: np.random.Generator | None) -> Array:
    """(1) and (3), through the wheel speeds."""
    r, L, Ts = 0.05, 0.6, 0.01
    wheels = np.array([u[0] - u[1] * L / 2, u[0] + u[1] * L / 2]) / r
    if random is not None:
        wheels += random.normal(size=2) * 0.1
    v, omega = r * wheels.sum() / 2, r * (wheels[1] - wheels[0]) / L
    return x + Ts * np.array([v * np.cos(x[2]), v * np.sin(x[2]), omega])
