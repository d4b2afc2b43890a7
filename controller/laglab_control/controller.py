"""Estimate, extrapolate, command: the remote station's part of a tick, without messages."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from laglab_control.config import StationConfig, is_far
from laglab_control.doubt import doubt
from laglab_control.errors import PluginError
from laglab_control.estimators.brought import Brought
from laglab_control.estimators.family import EstimatorKind, estimator_kind
from laglab_control.estimators.interface import (
    Calibration,
    Estimator,
    InForce,
    Measured,
    State,
    claim_of,
    pose_of,
)
from laglab_control.estimators.kalman import Belief, Innovation
from laglab_control.flight import Echo, Flight, hear, send, take_off
from laglab_control.guard import Alarm, Guard, Watched
from laglab_control.laws import STAND_STILL, Demand, as_input
from laglab_control.model import Matrix, Vector
from laglab_control.motion import Way, joined
from laglab_control.robot import Ways


class Control(NamedTuple):
    """The controller's knowledge at a tick; immutable."""

    estimate: State
    flight: Flight
    drive: Demand
    """The last command, as sent, and the law's memory."""
    pose: Vector | None = None
    """The estimate (3,) [m, m, rad] after the tick's correction; None: there is none."""
    P: Matrix | None = None
    """What is claimed for its error (3, 3): the estimator's covariance, and what is not known of
    the inputs; None: nothing."""
    plan: tuple[Demand, ...] = ()
    """What is to follow the last command, tick by tick, if nothing newer comes."""


@dataclass(frozen=True, eq=False)
class Controller:
    """Step 3 of a tick (docs/tick.md), as pure functions.

    At tick 0 `answer(start(), ...)`; at every later tick `answer(advance(control), ...)`. What
    somebody brought may raise PluginFailedError, in any of them; a guard around an estimator that
    does not show how wild a measurement is raises PluginError.
    """

    config: StationConfig

    @cached_property
    def kind(self) -> EstimatorKind:
        """What the estimator is."""
        return estimator_kind(self.config.estimator, self.config.estimator_options)

    @cached_property
    def _began(self) -> list[float]:
        """The initial estimate."""
        pose: list[float] = np.asarray(self.config.initial_estimate).tolist()
        return pose

    @cached_property
    def _estimator(self) -> Estimator[Any]:
        return self._guard or self.kind.make(self.config.model)

    @cached_property
    def _guard(self) -> Guard | None:
        if not self.config.guard:
            return None
        model, kind = self.config.model, self.kind
        estimator = kind.make(model)
        if isinstance(estimator, Brought) and not estimator.is_watchable:
            raise PluginError(
                f"estimator.guard: {estimator.name} has no method innovation(state), by which a "
                "guard sees what is wild: write one, or say estimator.guard = false"
            )
        if not estimator.is_watchable:
            return None
        return Guard(estimator, model, kind.learner(model) if kind.learner else None)

    def start(self) -> Control:
        """Tick 0, before its correction."""
        config = self.config
        x, P = np.array(config.initial_estimate), np.array(config.initial_covariance)
        flight = take_off(config.model, config.command_delay, config.plan)
        return Control(self._estimator.start(x, P), flight, STAND_STILL)

    def advance(self, control: Control) -> Control:
        """One tick later: the last command is on its way, the one n ticks older was applied."""
        estimate, flight, drive, _, _, plan = control
        all_planned = (drive, *plan) if self.config.plan else ()
        flight, applied = send(self._robot(estimate), flight, as_input(drive), all_planned)
        estimate = self._estimator.predict(estimate, self._applied(applied, drive))
        return Control(estimate, flight, drive, None, None, plan)

    def unanswered(self, control: Control) -> Control:
        """At a tick that never came here: the robot goes on in its plan, or holds what it has."""
        plan = control.plan
        return control._replace(drive=plan[0], plan=plan[1:]) if plan else control

    def expect(self, control: Control, s: int) -> Control:
        """The same, prepared for a measurement sampled at tick s, which is likely to come."""
        estimate, flight, drive, _, _, plan = control
        return Control(self._estimator.expect(estimate, s), flight, drive, None, None, plan)

    def answer(
        self,
        control: Control,
        measurements: Sequence[Measured],
        echoes: Sequence[Echo] = (),
        recalled: Sequence[InForce] = (),
    ) -> Control:
        """The tick's correction and command, from all that arrived.

        The robot is to stand still where no estimate is there to drive it by, or the estimate has
        diverged. Raises StampError for a measurement from before tick 0 or from the future.
        """
        config, last = self.config, control.drive
        estimate, flight, pose, P = self._corrected(control, measurements, echoes, recalled)
        if pose is None or self.diverged(pose):
            return Control(estimate, flight, STAND_STILL, pose, P)
        tick = config.first_tick + flight.tick + flight.command_delay
        there = self._there(estimate, flight, last, pose)
        drive = self.command(there, tick, last, P)
        if not config.plan:
            return Control(estimate, flight, drive, pose, P)
        plan = self._planned(there, tick, drive, P, self._robot(estimate))
        return Control(estimate, flight, drive, pose, P, plan)

    def _planned(
        self, there: Way[float], tick: int, first: Demand, P: Matrix | None, robot: Ways
    ) -> tuple[Demand, ...]:
        """u_{k+1|k} ... u_{k+H|k}, which would follow the command `first` if nothing new were
        learnt: law and model run forward from where the robot then is, `there` at its `tick`."""
        planned = [first]
        for ahead in range(1, self.config.plan + 1):
            there = joined(there, robot.way(as_input(planned[-1])))
            if is_far(there, self.config.goal):
                break
            planned.append(self.command(there, tick + ahead, planned[-1], P))
        return tuple(planned[1:])

    def correct(
        self,
        control: Control,
        measurements: Sequence[Measured],
        echoes: Sequence[Echo] = (),
        recalled: Sequence[InForce] = (),
    ) -> Control:
        """The tick's correction alone; `drive` is still the last command. Raises StampError."""
        estimate, flight, pose, P = self._corrected(control, measurements, echoes, recalled)
        return Control(estimate, flight, control.drive, pose, P)

    def _corrected(
        self,
        control: Control,
        measurements: Sequence[Measured],
        echoes: Sequence[Echo],
        recalled: Sequence[InForce],
    ) -> tuple[State, Flight, Vector | None, Matrix | None]:
        estimate, flight = control.estimate, control.flight
        flight, inputs = hear(self._robot(estimate), flight, echoes, recalled)
        if self._guard and isinstance(estimate, Watched):
            settled = flight.told.settled
            estimate = self._guard.correct(estimate, measurements, inputs, settled)
        else:
            estimate = self._estimator.correct(estimate, measurements, inputs)
        pose, P = pose_of(estimate), claim_of(estimate)
        if pose is not None and P is not None:
            unknown = doubt(flight, self.config.model, pose)
            P = P if unknown is None else P + unknown
        return estimate, flight, pose, P

    def command(self, there: Way[float], tick: int, last: Demand, P: Matrix | None) -> Demand:
        """What is sent after `last` for a robot that will be `there` [m, m, rad] at its `tick`.

        `P` (3, 3) is the covariance that is claimed for the present estimate.
        """
        config, sample_time = self.config, self.config.model.sample_time
        asked = config.law.drive(there, tick * sample_time, last.memory)
        return config.limits.limited(asked, P, last, sample_time)

    def diverged(self, x: Vector) -> bool:
        """Whether a pose estimate is not finite, or FAR from where it began and from the goal."""
        pose = x.tolist()
        return is_far(pose, self.config.goal) and is_far(pose, self._began)

    def warning(self, control: Control) -> str | None:
        """What nobody who relies on the estimate may overlook; None while there is nothing."""
        return self._estimator.warning(control.estimate) or self._guards_nothing

    @cached_property
    def _guards_nothing(self) -> str | None:
        idle = self.config.guard and self._guard is None
        name = self.config.estimator
        return f"{name} does not show what is wild: estimator.guard does nothing" if idle else None

    def innovation(self, control: Control) -> Innovation | None:
        """Of the newest measurement that came at this tick, as the estimator saw it."""
        return self._estimator.innovation(control.estimate)

    def at_arrival(self, control: Control) -> Belief | None:
        """The estimate of x_{k+n} by which the command was made, and the covariance that the model
        claims for it; None where there is no estimate."""
        x, P, flight = control.pose, control.P, control.flight
        if x is None or P is None:
            return None
        pose = self._there(control.estimate, flight, control.drive, x)
        for u in flight.in_flight if self.kind.predicts else ():
            x, P = self.config.model.predict(x, P, u)
        return Belief(np.array(pose), P)

    def learned(self, control: Control) -> tuple[Calibration, ...]:
        """What the estimator has learned of the robot besides its pose."""
        return self._estimator.learned(control.estimate)

    def alarm(self, control: Control) -> Alarm | None:
        """What the guard has found at this tick."""
        return control.estimate.alarm if isinstance(control.estimate, Watched) else None

    def gated(self, control: Control) -> int:
        """How many measurements the guard found too wild to be used."""
        return control.estimate.gated if isinstance(control.estimate, Watched) else 0

    def _robot(self, estimate: State) -> Ways:
        """As it is known by now."""
        return self._estimator.calibrated(estimate, self.config.model)

    def _applied(self, u: Vector, drive: Demand) -> Vector:
        """The input that the estimator is told."""
        return u

    def _there(self, estimate: State, flight: Flight, drive: Demand, x: Vector) -> Way[float]:
        """Where the robot will be when the command that is now made comes into force, as the
        estimator says, or by (29)."""
        ahead = self._estimator.ahead(estimate, flight.in_flight)
        if ahead is not None:
            return Way(*ahead.tolist())
        return self._at_arrival(Way(*x.tolist()), flight, drive)

    def _at_arrival(self, pose: Way[float], flight: Flight, drive: Demand) -> Way[float]:
        """(29): where the robot will be when the command that is now made comes into force."""
        return joined(pose, flight.ahead) if self.kind.predicts else pose
