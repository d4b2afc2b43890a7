"""`popf`: the paper's past-observation predictive filter (27), (28)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Belief, Innovation, gain, measured, times
from laglab_control.model import Matrix, Model, Vector, identity, symmetric
from laglab_control.past.history import History
from laglab_control.past.log import logged
from laglab_control.past.memory import MEMORY
from laglab_control.past.sliding import SlidingProduct


class Step(NamedTuple):
    """What a past tick j leaves behind: its prior and A_j (I - K_j H_j), one factor of (21)."""

    tick: int
    prior: Belief
    factor: Matrix


class Used(NamedTuple):
    """What the measurements used so far have left behind."""

    left: Matrix
    """The product of I - K_k H_k over the corrections made so far at this tick."""
    past: History[Step, Matrix]
    """Split at the newest measurement used: M* is the product of its window, but for that tick's
    own factor."""
    ticks: int
    """Bit i is set when z_{k-i} has been used."""
    lateness: int = 0
    """Of the latest one used at this tick [ticks]; 0 without any."""


class Correction(NamedTuple):
    """All of (28) for a measurement of tick s that does not depend on its value."""

    s: int
    prior: Belief
    """x^-_s and P^-_s."""
    S: Matrix
    """What is claimed for z_s - h(x^-_s)."""
    K: Matrix
    P: Matrix
    """P^+_k."""
    used: Used
    """With this one."""


class PopfState(NamedTuple):
    """The estimate x (d,) and covariance P (d, d) at `tick`, and the past that (28) looks at."""

    tick: int
    x: Vector
    P: Matrix
    prior: Belief
    """x^-_k and P^-_k."""
    used: Used
    innovation: Innovation | None = None
    expected: Correction | None = None
    """The one by the measurement that is expected at this tick."""


@dataclass(frozen=True)
class Popf(Estimator[PopfState]):
    """The paper's filter with (28) as (11) derives it.

    `innovation_at_k` takes h(x^-_k) for h(x^-_s), and `covariance_at_k` H_k for H_s, as (28) prints
    them: kept only to show what that costs.

    A measurement may come in any order, less than `memory` ticks late: M* is taken from its own
    tick on. The derivation takes the errors of corrections that overlap for independent, so P comes
    out too small; that of `popf-exact` does not.
    """

    model: Model
    innovation_at_k: bool = False
    covariance_at_k: bool = False
    memory: int = MEMORY

    def start(self, x: Vector, P: Matrix) -> PopfState:
        """The prior of tick 0."""
        I = identity(len(x))  # noqa: E741
        window: SlidingProduct[Step, Matrix] = SlidingProduct(_compose, I)
        past = History(window, since=0, older=logged(), memory=self.memory)
        return PopfState(0, x, P, Belief(x, P), Used(I, past, ticks=0))

    def predict(self, state: PopfState, u: Vector) -> PopfState:
        """(27), and one more factor for (21)."""
        tick, x, P, prior, (left, past, used, _), *_ = state
        factor = self.model.A(x, u).dot(left)
        past = past.push(tick, Step(tick, prior, factor), factor)
        used = (used << 1) % (1 << self.memory)
        prior = Belief(*self.model.predict(x, P, u))
        return PopfState(tick + 1, *prior, prior, Used(identity(len(x)), past, used))

    def correct(
        self, state: PopfState, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> PopfState:
        """(28) for every measurement that is not a repeat and not too old."""
        for s, z in by_sampling(measurements, state.tick):
            if self._useful(state, s):
                state = self._correct(state, s, z)
        return state

    def expect(self, state: PopfState, s: int) -> PopfState:
        """With the gain for s, and the covariance after it: (21) to (24)."""
        if not (0 <= s <= state.tick and self._useful(state, s)):
            return state
        tick, x, P, prior, used, innovation, _ = state
        expected = self._correction(state, s)
        return PopfState(tick, x, P, prior, used, innovation, expected)

    def _useful(self, state: PopfState, s: int) -> bool:
        lateness = state.tick - s
        return lateness < self.memory and not state.used.ticks >> lateness & 1

    def _correct(self, state: PopfState, s: int, z: Vector) -> PopfState:
        """(11)."""
        tick, x, _, prior, _, _, correction = state
        if correction is None or correction.s != s:
            correction = self._correction(state, s)
        _, prior_s, S, K, P, used = correction
        v = self.model.innovation(z, self.model.h(prior_s.x))
        taken = self.model.innovation(z, self.model.h(prior.x)) if self.innovation_at_k else v
        return PopfState(tick, x + K.dot(taken), P, prior, used, Innovation(v, S))

    def _correction(self, state: PopfState, s: int) -> Correction:
        tick, _, P, prior, (left, past, used, lateness), *_ = state
        past = past.split(at=min(s, tick - 1))
        prior_s, M = (prior, left) if s == tick else _prior_and_M(past, s, left)
        (x_s, P_s), model = prior_s, self.model
        H = model.H(x_s)
        PHt, HPHt = measured(P_s, H)
        cross = M.dot(PHt)
        S = HPHt + model.measurement_noise(x_s)
        K = gain(cross, S)  # (24)
        H_k = model.H(prior.x)
        seen = M.dot(P_s).dot(H_k.T) if self.covariance_at_k else cross
        P = symmetric(P - K.dot(seen.T))  # (23)
        left = left - times(K, H_k).dot(left)
        with_this = Used(left, past, used | 1 << tick - s, max(lateness, tick - s))
        return Correction(s, prior_s, S, K, P, with_this)

    def innovation(self, state: PopfState) -> Innovation | None:
        """z_s - h(x^-_s)."""
        return state.innovation

    def warning(self, state: PopfState) -> str | None:
        """When the gain is above `delay_limit`."""
        lateness = state.used.lateness
        limit = delay_limit(lateness)
        largest = 1.0 - min(state.used.left.diagonal().tolist())
        if largest <= limit:
            return None
        return (
            f"popf's gain is {largest:.3f}; above {limit:.3f} a delay of {lateness} ticks can make "
            "it diverge: take a smaller P_0, or delayed-ekf"
        )


def delay_limit(m: int) -> float:
    """The gain above which (11) with a delay of m ticks is unstable, for a scalar at rest.

    x~_{k+1} = x~_k - K x~_{k-m} has its roots inside the unit circle for 0 < K < this limit
    (Levin and May 1976; docs/theory.md, "The delay limit of the gain").
    """
    return 2 * math.sin(math.pi / (2 * (2 * m + 1)))


def _prior_and_M(past: History[Step, Matrix], s: int, left: Matrix) -> tuple[Belief, Matrix]:
    """The prior of tick s, and M* (21) from there to this tick and its corrections so far."""
    M = left.dot(past.window.product)
    for step in past.backwards():
        M = M.dot(step.factor)
        if step.tick == s:
            return step.prior, M
    raise IndexError(f"tick {s} is no longer kept")


def _compose(older: Matrix, newer: Matrix) -> Matrix:
    """Later factors of (21) stand to the left."""
    product: Matrix = newer.dot(older)
    return product
