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
    Present,
    Setting,
    WindowedEkf,
)
from laglab_control.batch.flight import Flight, place_of, sent, take_off
from laglab_control.batch.guard import Found
from laglab_control.batch.law import Demands, drive, limited, polar_law, stand_still
from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.robots import Robots, diverged, prior_of
from laglab_control.batch.rows import Pose, Speeds, headings
from laglab_control.config import StationConfig
from laglab_control.errors import ConfigError
from laglab_control.estimators.family import estimator_kind
from laglab_control.laws import PolarLaw
from laglab_control.model import Matrix


class BatchControl(NamedTuple):
    """The knowledge of all controllers at a tick; immutable."""

    estimator: Any
    """Its state."""
    found: Found | None
    """By the guards; None: there are none."""
    flight: Flight
    """All commands."""
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
        """How many there are."""
        return int(np.shape(self.initial_estimates)[1])

    @cached_property
    def _robots(self) -> Robots:
        return Robots(self.config.model)

    @cached_property
    def _law(self) -> PolarLaw:
        return polar_law(self.config)

    @cached_property
    def _exact(self) -> bool:
        """Also where the wheels differ: an odometer takes them for alike."""
        return self.exact or not self._robots.wheels_are_alike

    @cached_property
    def _estimator(self) -> BatchEstimator[Any]:
        setting = Setting(self._robots, self.measurement_delay)
        kind = self.config.estimator
        make = WindowedEkf if self._exact and kind == "delayed-ekf" else BATCHED[kind]
        return make(setting)

    @cached_property
    def _predicts(self) -> bool:
        return estimator_kind(self.config.estimator).predicts

    def start(self) -> BatchControl:
        """Tick 0, before its correction."""
        prior = prior_of(self.config, self.initial_estimates)
        flight = take_off(self.config, self.robots, self._exact)
        found = guard.nothing_found(self.robots) if self.config.guard else None
        lost = np.zeros(self.robots, np.bool_)
        standing = stand_still(self.robots)
        return BatchControl(self._estimator.start(prior), found, flight, standing, lost)

    def advance(self, control: BatchControl) -> BatchControl:
        """One tick later: the last commands are on their way, those n ticks older were applied."""
        flight = sent(self.config, control.flight, control.drive.speeds)
        applied = flight.applied
        state = self._estimator.predict(control.estimator, applied)
        return control._replace(estimator=state, flight=flight)

    def answer(self, control: BatchControl, z: Pose | None) -> BatchControl:
        """The tick's correction by z_{k-m}, None before tick m, and the commands."""
        state, found, flight, last, lost, *_ = control
        if z is not None:
            state, compared = self._estimator.correct(state, z)
            if found is not None and compared is not None:
                found = guard.looked_at(found, compared)
        now = flight.applied
        present = self._estimator.estimate(state, now)
        if present is None:
            return BatchControl(state, found, flight, stand_still(self.robots), lost)
        pose, _, P = present
        if P is not None and found is not None:
            P = guard.claimed(P, found)
        lost = lost | diverged(pose, self.config.goal, self.initial_estimates)
        demands = self._command(present._replace(P=P), flight, last, lost)
        return BatchControl(state, found, flight, demands, lost, pose, P)

    def _command(
        self, present: Present, flight: Flight, last: Demands, lost: NDArray[np.bool_]
    ) -> Demands:
        (there, turn, P), config = present, self.config
        if self._predicts:
            there, heading = place_of(flight, there, turn)
        else:
            heading = headings(there.theta)
        speeds, at_goal = drive(self._law, there, last.at_goal, None if self._exact else heading)
        speeds = limited(config.limits, speeds, P, last.speeds, config.model.sample_time)
        if lost.any():
            speeds = Speeds(*[np.where(lost, 0.0, each) for each in speeds])
        return Demands(speeds, at_goal)
