"""`popf` as its equations stand, term by term: what its fast form is held against."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Belief, Innovation
from laglab_control.model import Matrix, Model, Vector, identity
from laglab_control.past.log import Log, append, logged


class Step(NamedTuple):
    """What a past tick j leaves behind: its prior and A_j (I - K_j H_j), one factor of (21)."""

    prior: Belief
    factor: Matrix


class LiteralState(NamedTuple):
    """The estimate x (d,) and covariance P (d, d) at `tick`, and all that was before."""

    tick: int
    x: Vector
    P: Matrix
    prior: Belief
    """x^-_k and P^-_k."""
    left: Matrix
    """The product of I - K_k H_k over the corrections made so far at this tick."""
    past: Log[Step]
    """From tick 0 on."""
    used: int = 0
    """Bit s is set when z_s has been used."""
    innovation: Innovation | None = None


@dataclass(frozen=True)
class LiteralPopf(Estimator[LiteralState]):
    """(27), (28) with the product M* of (21) taken anew for every measurement.

    A measurement m ticks late costs m products, and nothing is ever forgotten: for tests and
    benchmarks. Takes what comes late, repeated or out of order as `Popf` does.
    """

    model: Model

    def start(self, x: Vector, P: Matrix) -> LiteralState:
        """The prior of tick 0."""
        return LiteralState(0, x, P, Belief(x, P), identity(len(x)), logged())

    def predict(self, state: LiteralState, u: Vector) -> LiteralState:
        """(27)."""
        tick, x, P, prior, left, past, used, _ = state
        step = Step(prior, self.model.A(x, u).dot(left))
        past = append(past, step, limit=tick + 1)
        prior = Belief(*self.model.predict(x, P, u))
        return LiteralState(tick + 1, *prior, prior, identity(len(x)), past, used)

    def correct(
        self,
        state: LiteralState,
        measurements: Sequence[Measured],
        inputs: Sequence[InForce] = (),
    ) -> LiteralState:
        """(28) for each measurement that has not been used yet, oldest first."""
        for s, z in by_sampling(measurements, state.tick):
            if not state.used >> s & 1:
                state = self._with(state, s, z)
        return state

    def _with(self, state: LiteralState, s: int, z: Vector) -> LiteralState:
        tick, x, P, prior, left, past, used, _ = state
        x_s, P_s = prior if s == tick else past.items[s].prior
        H, M = self.model.H(x_s), left  # (21)
        for step in reversed(past.items[s:tick]):
            M = M.dot(step.factor)
        PHt = P_s.dot(H.T)
        S = H.dot(PHt) + self.model.measurement_noise(x_s)
        K = M.dot(PHt).dot(np.linalg.inv(S))  # (24)
        v = self.model.innovation(z, self.model.h(x_s))
        x = x + K.dot(v)  # (11)
        P = P - K.dot(H).dot(P_s).dot(M.T)  # (23)
        P = (P + P.T) / 2
        left = left - K.dot(self.model.H(prior.x)).dot(left)
        return LiteralState(tick, x, P, prior, left, past, used | 1 << s, Innovation(v, S))

    def innovation(self, state: LiteralState) -> Innovation | None:
        """z_s - h(x^-_s)."""
        return state.innovation
