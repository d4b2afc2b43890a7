"""Estimate, extrapolate, command, for many robots: `Controller` with an array for each number."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch import guard
from laglab_control.batch.estimators import (
    BATCHED,
    BatchEstimator,
    Setting,
    TurnedEstimate,
)
from laglab_control.batch.guard import Found
from laglab_control.batch.law import Demands, drive, limited, polar_law, stand_still
from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.robots import Robots, diverged, prior_of
from laglab_control.batch.rows import Pose, Speeds
from laglab_control.batch.turning import Turned, TurnedWay, Turning, nowhere, turned, way_of
from laglab_control.controller import StationConfig
from laglab_control.errors import ConfigError
from laglab_control.estimators.family import estimator_kind
from laglab_control.laws import PolarLaw
from laglab_control.model import Matrix
from laglab_control.past.sliding import SlidingProduct


class BatchControl(NamedTuple):
    """The knowledge of all controllers at a tick; immutable."""

    estimator: Any
    """Its state."""
    found: Found | None
    """By the guards; None: there are none."""
    in_flight: SlidingProduct[Turned, TurnedWay]
    drive: Demands
    """The last commands."""
    lost: NDArray[np.bool_]
    """The robots whose estimate has diverged."""
    pose: Pose | None = None
    """The estimates after the tick's correction; None: there are none."""
    P: Symmetric | None = None
    """What is claimed for their errors."""


@dataclass(frozen=True, eq=False)
class BatchController:
    """As many controllers as there are initial estimates (3, robots) [m, m, rad], all else alike.

    The link is one that delivers: every command comes into force n = `config.command_delay` ticks
    after it was made, every measurement comes `measurement_delay` ticks after it was sampled, and
    none is refused. At tick 0 `answer(start(), ...)`; at every later tick
    `answer(advance(control), ...)`.

    Raises ConfigError when there is no such estimator or law for many robots, or R is not diagonal.
    """

    config: StationConfig
    initial_estimates: Matrix
    measurement_delay: int
    exact: bool = True
    """To the last bit, which takes twice the time; without noise it is the last bit that decides
    where a robot at its goal looks."""

    def __post_init__(self) -> None:
        kind = self.config.estimator
        if kind not in BATCHED:
            raise ConfigError(f"there is no {kind} for many robots, but {', '.join(BATCHED)}")
        _ = self._robots, self._law  # refuses what it cannot be

    @property
    def robots(self) -> int:
        """How many."""
        return int(np.shape(self.initial_estimates)[1])

    @cached_property
    def _robots(self) -> Robots:
        return Robots(self.config.model)

    @cached_property
    def _law(self) -> PolarLaw:
        return polar_law(self.config)

    @cached_property
    def _turning(self) -> Turning:
        return Turning(self.exact)

    def _step(self, u: Speeds) -> Turned:
        return turned(self._robots.motion(u))

    @cached_property
    def _estimator(self) -> BatchEstimator[Any]:
        setting = Setting(self._robots, self._turning, self.measurement_delay)
        return BATCHED[self.config.estimator](setting)

    @cached_property
    def _predicts(self) -> bool:
        return estimator_kind(self.config.estimator).predicts

    def start(self) -> BatchControl:
        """Tick 0, before its correction."""
        prior = prior_of(self.config, self.initial_estimates)
        standing = stand_still(self.robots)
        flight: SlidingProduct[Turned, TurnedWay]
        flight = SlidingProduct(self._turning.joined, way_of(nowhere()))
        for _ in range(self.config.command_delay):
            flight = _sent(flight, self._step(standing.speeds))
        found = guard.nothing_found(self.robots) if self.config.guard else None
        lost = np.zeros(self.robots, np.bool_)
        return BatchControl(self._estimator.start(prior), found, flight, standing, lost)

    def advance(self, control: BatchControl) -> BatchControl:
        """One tick later: the last commands are on their way, those n ticks older were applied."""
        sent = self._step(control.drive.speeds)
        applied, in_flight = _sent(control.in_flight, sent).pop()
        state = self._estimator.predict(control.estimator, applied)
        return control._replace(estimator=state, in_flight=in_flight)

    def answer(self, control: BatchControl, z: Pose | None) -> BatchControl:
        """The tick's correction by z_{k-m}, None before tick m, and the commands."""
        state, found, in_flight, last, lost, *_ = control
        if z is not None:
            state, compared = self._estimator.correct(state, z)
            if found is not None and compared is not None:
                found = guard.looked_at(found, compared)
        estimate = self._estimator.estimate(state)
        if estimate is None:
            return BatchControl(state, found, in_flight, stand_still(self.robots), lost)
        (pose, _), P = estimate
        if P is not None and found is not None:
            P = guard.claimed(P, found)
        lost = lost | diverged(pose, self.config.goal, self.initial_estimates)
        demands = self._command(estimate._replace(P=P), in_flight, last, lost)
        return BatchControl(state, found, in_flight, demands, lost, pose, P)

    def _command(
        self,
        estimate: TurnedEstimate,
        in_flight: SlidingProduct[Turned, TurnedWay],
        last: Demands,
        lost: NDArray[np.bool_],
    ) -> Demands:
        (pose, P), config = estimate, self.config
        there = self._turning.joined(pose, in_flight.product) if self._predicts else pose
        heading = None if self.exact else there.heading
        speeds, at_goal = drive(self._law, there.way, last.at_goal, heading)
        speeds = limited(config.limits, speeds, P, last.speeds, config.model.sample_time)
        if lost.any():
            speeds = Speeds(*[np.where(lost, 0.0, each) for each in speeds])
        return Demands(speeds, at_goal)


def _sent(
    flight: SlidingProduct[Turned, TurnedWay], sent: Turned
) -> SlidingProduct[Turned, TurnedWay]:
    return flight.push(sent, way_of(sent))
