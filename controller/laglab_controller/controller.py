"""Estimate, extrapolate, command: the remote station's part of a tick, without messages."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from laglab_controller.errors import ConfigError
from laglab_controller.estimator import Estimator, Measured, State
from laglab_controller.family import Kind, estimator_kind
from laglab_controller.law import STAND_STILL, Drive, Law, as_input
from laglab_controller.model import Vector, constant
from laglab_controller.motion import STILL, Motion, compose
from laglab_controller.robot import RobotModel
from laglab_controller.sliding import SlidingProduct

DIVERGED = 1000.0
"""[m] from the origin: no estimate of a robot that a run is about is ever there."""


@dataclass(frozen=True, eq=False)
class StationConfig:
    """What the station is told. Poses [m, m, rad], delays in ticks.

    `estimator` is one of ESTIMATORS. Raises ConfigError, naming the field, when one is not right.
    """

    estimator: str = "popf"
    model: RobotModel = field(default_factory=RobotModel)
    law: Law = field(default_factory=Law)
    initial_estimate: ArrayLike = (0.0, 0.0, 0.0)
    initial_covariance: ArrayLike = field(default_factory=lambda: np.eye(3) * 1e-4)
    command_delay: int = 0
    """n. The delay m of the measurements is read from their stamps."""

    def __post_init__(self) -> None:
        estimator_kind(self.estimator)
        for name, shape in (("initial_estimate", (3,)), ("initial_covariance", (3, 3))):
            object.__setattr__(self, name, constant(getattr(self, name), shape, name))
        if self.command_delay < 0:
            raise ConfigError(f"command_delay must be 0 ticks or more, not {self.command_delay}")


class Control(NamedTuple):
    """The controller's knowledge at a tick; immutable."""

    estimate: State
    in_flight: SlidingProduct[Vector, Motion]
    """u_{k-n} ... u_{k-1}, as sent; zeros for what was sent before tick 0."""
    drive: Drive
    """The last command."""


@dataclass(frozen=True, eq=False)
class Controller:
    """Step 3 of a tick, as pure functions.

    At tick 0 `answer(start(), ...)`; at every later tick `answer(advance(control), ...)`.
    """

    config: StationConfig

    @cached_property
    def kind(self) -> Kind:
        """What the estimator is."""
        return estimator_kind(self.config.estimator)

    @cached_property
    def _estimator(self) -> Estimator[Any]:
        return self.kind.make(self.config.model)

    def start(self) -> Control:
        """Tick 0, before its correction."""
        in_flight: SlidingProduct[Vector, Motion] = SlidingProduct(compose, STILL)
        for _ in range(self.config.command_delay):
            in_flight = self._sent(in_flight, STAND_STILL)
        x, P = np.array(self.config.initial_estimate), np.array(self.config.initial_covariance)
        return Control(self._estimator.start(x, P), in_flight, STAND_STILL)

    def advance(self, control: Control) -> Control:
        """One tick later: the last command is on its way, the one n ticks older was applied."""
        in_flight = self._sent(control.in_flight, control.drive)
        applied, in_flight = in_flight.pop()
        estimate = self._estimator.predict(control.estimate, applied)
        return control._replace(estimate=estimate, in_flight=in_flight)

    def answer(self, control: Control, measurements: Sequence[Measured]) -> Control:
        """The tick's correction and command: the robot stands still when there is no estimate to
        drive it by, or when that estimate has diverged."""
        estimate = self._estimator.correct(control.estimate, measurements)
        control = control._replace(estimate=estimate)
        if estimate.x is None or diverged(estimate.x):
            return control._replace(drive=STAND_STILL)
        pose = self._at_arrival(estimate.x, control.in_flight)
        return control._replace(drive=self.config.law.drive(pose, control.drive.at_goal))

    def _at_arrival(self, x: Vector, in_flight: SlidingProduct[Vector, Motion]) -> Vector:
        """(29): where the robot will be when the command that is now made comes into force."""
        if not self.kind.predicts:
            return x
        return np.array(compose(Motion(*x.tolist()), in_flight.product)[:3])

    def _sent(
        self, in_flight: SlidingProduct[Vector, Motion], drive: Drive
    ) -> SlidingProduct[Vector, Motion]:
        u = as_input(drive)
        return in_flight.push(u, self.config.model.motion(u))


def diverged(x: Vector) -> bool:
    """Whether a pose estimate is not finite, or further than DIVERGED from the origin."""
    return not np.all(np.isfinite(x)) or math.hypot(x[0], x[1]) > DIVERGED
