"""An estimator that is watched: wild measurements are not used, and when what is measured cannot be
explained any more, an alarm is raised and the estimate begins again from what is measured."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from laglab_control.estimators.delayed.delayed_ekf import DelayedEkf, DelayedState
from laglab_control.estimators.delayed.windows import RigidMotions
from laglab_control.estimators.interface import (
    Calibration,
    Estimator,
    InForce,
    Measured,
    State,
    by_sampling,
    pose_of,
)
from laglab_control.estimators.kalman import Belief, Innovation, precision, weighted
from laglab_control.guard.evidence import (
    WILD,
    Contradiction,
    Evidence,
    Lag,
    contradiction,
    lagging,
    no_evidence,
    weighed,
)
from laglab_control.guard.seen import Seen
from laglab_control.model import Matrix, Vector
from laglab_control.past.log import Log, append, logged
from laglab_control.past.memory import MEMORY
from laglab_control.robot import RobotModel, Ways

LOCATING = 100
"""Measurements by which the pose is found again: P is then R/100, which every filter can start
from (`popf` diverges from a P_0 as large as R, docs/theory.md)."""


class Alarm(NamedTuple):
    """What is measured contradicts what is estimated."""

    tick: int
    cause: str


class Watched(NamedTuple):
    """An estimator's state, and what the guard knows; immutable."""

    state: State
    """Of the estimator, of the one that finds the pose, or of the one that learns. Its tick 0 is
    tick `origin`."""
    origin: int
    learning: bool
    """Whether the learner has taken over, for good."""
    aside: State | None
    """While the pose is being found: the estimator's state when it was given up."""
    found: int
    """Measurements used since then."""
    evidence: Evidence
    lag: Lag | None
    """What the innovations suggest that the estimate is off by."""
    inputs: Log[Vector]
    """As believed or known, up to the one that led to the present."""
    seen: Seen
    gated: int
    """Measurements that were too wild to be used."""
    alarm: Alarm | None
    """Raised at this tick."""

    @property
    def tick(self) -> int:
        """k."""
        return self.state.tick + self.origin

    @property
    def x(self) -> Vector | None:
        """The estimate (d,)."""
        return self.state.x

    @property
    def pose(self) -> Vector | None:
        """The pose in it (3,)."""
        return pose_of(self.state)

    @property
    def P(self) -> Matrix | None:
        """Its covariance (d, d), and b b^T where the innovations suggest an error b of the pose."""
        P, lag = self.state.P, self.lag
        if P is None or lag is None:
            return P
        P = P.copy()
        P[:3, :3] += np.outer(lag.mean, lag.mean)
        return P

    def judged(
        self, state: State, evidence: Evidence, lag: Lag | None, seen: Seen, gated: int
    ) -> "Watched":
        """With what a measurement makes of these."""
        _, origin, learning, aside, found, _, _, inputs, _, _, alarm = self
        return Watched(
            state, origin, learning, aside, found, evidence, lag, inputs, seen, gated, alarm
        )


@dataclass(frozen=True, eq=False)
class Guard(Estimator[Watched]):
    """Around any estimator of the robot's pose.

    Each measurement is tried, for the estimator is a pure function: one that turns out to be wild
    (its normalised innovation squared is beyond the 1 - 1e-6 quantile) is not taken. After an
    alarm the estimate is the newest measurement with P = R, and a `delayed-ekf`, which copes with
    that, stands in until LOCATING measurements have come; then the estimator goes on from there.

    Where the estimate lags behind, the model is wrong. A `learner`, if there is one, then takes
    over for good: it learns of the robot what the estimator takes for known.
    """

    estimator: Estimator[Any]
    model: RobotModel
    learner: Estimator[Any] | None = None

    @cached_property
    def _locator(self) -> Estimator[Any]:
        return DelayedEkf(self.model, RigidMotions(self.model))

    def start(self, x: Vector, P: Matrix) -> Watched:
        """The estimator's own."""
        inner = self.estimator.start(x, P)
        return Watched(inner, 0, False, None, 0, no_evidence(), None, logged(), Seen(), 0, None)

    def predict(self, state: Watched, u: Vector) -> Watched:
        """The estimator's own."""
        inner, origin, learning, aside, found, evidence, lag, inputs, seen, gated, _ = state
        inner = self._active(state).predict(inner, u)
        inputs = append(inputs, u, MEMORY)
        return Watched(
            inner, origin, learning, aside, found, evidence, lag, inputs, seen, gated, None
        )

    def correct(
        self,
        state: Watched,
        measurements: Sequence[Measured],
        inputs: Sequence[InForce] = (),
        settled: int | None = None,
    ) -> Watched:
        """Measurement by measurement, in the order of sampling.

        `settled`: up to this tick the inputs are known. What was sampled later is used but proves
        nothing: the robot may have done something else. None: all are known. Raises StampError.
        """
        if inputs:
            state = self._put_right(state, inputs)
        for measured in by_sampling(measurements, state.tick):
            state = self._take(state, measured, settled)
        return state

    def expect(self, state: Watched, s: int) -> Watched:
        """The estimator's own."""
        inner = self._active(state).expect(state.state, s - state.origin)
        if inner is state.state:
            return state
        return state.judged(inner, state.evidence, state.lag, state.seen, state.gated)

    def ahead(self, state: Watched, inputs: Iterable[Vector]) -> Vector | None:
        """The estimator's own."""
        return self._active(state).ahead(state.state, inputs)

    def calibrated(self, state: Watched, robot: Ways) -> Ways:
        """As whoever learns has it, even while its own pose is given up."""
        learner, known = self._learned(state)
        return learner.calibrated(known, robot)

    def learned(self, state: Watched) -> tuple[Calibration, ...]:
        """As whoever learns has it, even while its own pose is given up."""
        learner, known = self._learned(state)
        return learner.learned(known)

    def _learned(self, state: Watched) -> tuple[Estimator[Any], State]:
        if state.learning:
            return self._active(state), state.state
        return self.estimator, state.state if state.aside is None else state.aside

    def innovation(self, state: Watched) -> Innovation | None:
        """The estimator's own."""
        return self._active(state).innovation(state.state)

    def warning(self, state: Watched) -> str | None:
        """As whoever estimates now has it."""
        return self._active(state).warning(state.state)

    def _active(self, state: Watched) -> Estimator[Any]:
        if state.learning and self.learner:
            return self.learner
        return self.estimator if state.aside is None else self._locator

    def _put_right(self, state: Watched, inputs: Sequence[InForce]) -> Watched:
        """With the inputs that were others than believed."""
        items, length = state.inputs
        tick = state.tick
        first = tick - length
        for j, u in inputs:
            if first <= j < tick and items[j - first].tolist() != u.tolist():
                return self._revised(state, {j: u for j, u in inputs if first <= j < tick})
        return state

    def _revised(self, state: Watched, known: Mapping[int, Vector]) -> Watched:
        items, length = state.inputs
        first = state.tick - length
        inputs = [known.get(j, u) for j, u in enumerate(items[:length], start=first)]
        since = [InForce(j - state.origin, u) for j, u in known.items() if j >= state.origin]
        inner = self._active(state).correct(state.state, (), since)
        return state._replace(state=inner, inputs=logged(*inputs))

    def _take(self, state: Watched, measured: Measured, settled: int | None) -> Watched:
        s, z = measured
        if s in state.seen or s < state.origin:
            return state
        if not all(map(math.isfinite, z.tolist())):  # says nothing
            seen, gated = state.seen.and_of(s), state.gated + 1
            return state.judged(state.state, state.evidence, state.lag, seen, gated)
        active = self._active(state)
        tried = active.correct(state.state, [Measured(s - state.origin, z)])
        innovation = active.innovation(tried)
        if innovation is None or not (settled is None or s <= settled + 1):
            seen = state.seen.and_of(s)
            return self._used(state.judged(tried, state.evidence, state.lag, seen, state.gated))
        return self._judged(state, measured, tried, innovation)

    def _judged(
        self, state: Watched, measured: Measured, tried: State, innovation: Innovation
    ) -> Watched:
        v, weights, evidence = innovation.value.tolist(), precision(innovation.S), state.evidence
        nis = weighted(v, weights)
        found, lag, seen = None, state.lag, state.seen.and_of(measured.tick)
        if seen.newest == measured.tick:  # what is late was weighed by those after it
            evidence = weighed(evidence, v, nis)
            lag = lagging(evidence, weights, lag)
            found = contradiction(evidence, lag)
        is_wild = not nis <= WILD  # so is what is not finite
        taken, gated = (state.state, state.gated + 1) if is_wild else (tried, state.gated)
        state = state.judged(taken, evidence, lag, seen, gated)
        if found:
            return self._begun_again(state, measured, found)
        return state if is_wild else self._used(state)

    def _used(self, state: Watched) -> Watched:
        """One more of those by which the pose is found, if it is being found."""
        if state.aside is None:
            return state
        state = state._replace(found=state.found + 1)
        return self._resumed(state) if state.found >= LOCATING else state

    def _begun_again(self, state: Watched, measured: Measured, found: Contradiction) -> Watched:
        """The measurement is all that is known of the pose."""
        x = np.array(measured.z)
        before = state.pose
        if before is not None and math.isfinite(before[2]):
            x[2] += 2 * math.pi * round(float(before[2] - x[2]) / (2 * math.pi))
        state, begun = self._replacement(state, x, found.drift)
        state = self._from(state._replace(evidence=no_evidence(), lag=None), measured.tick, begun)
        return state._replace(alarm=Alarm(state.tick, found.cause))

    def _replacement(self, state: Watched, x: Vector, drift: bool) -> tuple[Watched, State]:
        """Who goes on from x, with P = R."""
        R = self.model.R
        if state.learning:
            return state, self._active(state).restart(state.state, x, R)
        if drift and self.learner:
            return state._replace(learning=True, aside=None), self.learner.start(x, R)
        aside = state.state if state.aside is None else state.aside
        return state._replace(aside=aside, found=1), self._locator.start(x, R)

    def _resumed(self, state: Watched) -> Watched:
        """The pose is known again at the newest measurement's tick: the estimator goes on there."""
        s, belief = self._found(state)
        begun = self.estimator.restart(state.aside, *belief)
        return self._from(state._replace(aside=None), s, begun)

    def _found(self, state: Watched) -> tuple[int, Belief]:
        assert isinstance(state.state, DelayedState), "the locator's"
        newest = state.state.filtered.newest
        return newest.tick + state.origin, newest.posterior

    def _from(self, state: Watched, origin: int, inner: State) -> Watched:
        """With `inner` as of tick `origin`, carried on to the present over the inputs since."""
        active, tick = self._active(state), state.tick
        items, length = state.inputs
        for u in items[length - (tick - origin) : length]:
            inner = active.predict(inner, u)
        return state._replace(state=inner, origin=origin)
