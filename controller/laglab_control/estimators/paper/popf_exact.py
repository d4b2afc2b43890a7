"""`popf-exact`: the structure of `popf`, with the covariances that its errors really have."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Innovation, gain
from laglab_control.model import Matrix, Model, Vector, symmetric


class Prior(NamedTuple):
    """x^-_j (d,) of a past tick j, and `row` (length, d, d): row[i] = E[x~^-_j x~^-_{j-i}^T]."""

    x: Vector
    row: Matrix


class ExactState(NamedTuple):
    """The estimate x (d,) and covariance P (d, d) at `tick`, and how its error is correlated
    with those of the past."""

    tick: int
    x: Vector
    P: Matrix
    row: Matrix
    """C_i = E[x~_k x~^-_{k-i}^T], i = 0, 1, ...: x~_k with the corrections made so far."""
    priors: tuple[Prior, ...]
    """Of ticks k - len(priors) + 1 ... k."""
    newest: int
    """The tick of the newest measurement used."""
    innovation: Innovation | None


@dataclass(frozen=True)
class PopfExact(Estimator[ExactState]):
    """(11) with the best gain for it: (19) and (20) take the noise of corrections that overlap for
    white; here their covariances are carried along instead.

    A measurement is used when it is newer than all used before and less than `memory` ticks late.
    The cost of a tick grows with the delay, and the memory with its square.
    """

    model: Model
    memory: int = 512

    def start(self, x: Vector, P: Matrix) -> ExactState:
        """The prior of tick 0."""
        row = P[np.newaxis]
        return ExactState(0, x, P, row, (Prior(x, row),), newest=-1, innovation=None)

    def predict(self, state: ExactState, u: Vector) -> ExactState:
        """(27), and E[x~^-_{k+1} x~^-_{k-i}^T] = A C_i."""
        x, P = self.model.predict(state.x, state.P, u)
        row = np.concatenate((P[np.newaxis], self.model.A(state.x, u) @ state.row))
        row, priors = row[: self.memory], state.priors[-self.memory + 1 :]
        return ExactState(state.tick + 1, x, P, row, (*priors, Prior(x, row)), state.newest, None)

    def correct(
        self, state: ExactState, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> ExactState:
        """(11) for every measurement newer than all before."""
        for s, z in by_sampling(measurements, state.tick):
            if s > state.newest and state.tick - s < len(state.priors):
                state = self._correct(state, s, z)
        return state

    def _correct(self, state: ExactState, s: int, z: Vector) -> ExactState:
        """x~+ = x~ - K (H x~^-_s - v_s): K is the best one, and the C_i follow."""
        tick, x, P, row, priors, _, _ = state
        m = tick - s
        priors, row = priors[-m - 1 :], row[: m + 1]
        x_s, P_s, C_m = priors[0].x, priors[0].row[0], row[m]
        H = self.model.H(x_s)
        S = H @ P_s @ H.T + self.model.measurement_noise(x_s)
        K, v = gain(C_m @ H.T, S), self.model.innovation(z, self.model.h(x_s))
        since_s = np.stack([prior.row[j].T for j, prior in enumerate(priors)])
        return ExactState(
            tick,
            x + K @ v,
            symmetric(P - K @ H @ C_m.T),
            row - K @ H @ since_s[::-1],
            priors,
            newest=s,
            innovation=Innovation(v, S),
        )

    def innovation(self, state: ExactState) -> Innovation | None:
        """z_s - h(x^-_s)."""
        return state.innovation
