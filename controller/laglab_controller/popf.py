"""`popf`: the paper's past-observation predictive filter (27), (28)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from laglab_controller.estimator import Applied, Measured, by_sampling
from laglab_controller.history import History
from laglab_controller.kalman import Belief, Compared, Innovation, gain, innovation
from laglab_controller.model import Matrix, Model, Vector, identity, symmetric
from laglab_controller.sliding import SlidingProduct


class Step(NamedTuple):
    """What a past tick j leaves behind: its prior and A_j (I - K_j H_j), one factor of (21)."""

    tick: int
    prior: Belief
    factor: Matrix


class PopfState(NamedTuple):
    """The estimate x (d,) and covariance P (d, d) at `tick`, and the past that (28) looks at."""

    tick: int
    x: Vector
    P: Matrix
    prior: Belief
    """x^-_k and P^-_k."""
    left: Matrix
    """The product of I - K_k H_k over the corrections made so far at this tick."""
    past: History[Step, Matrix]
    """Split at the newest measurement used: M* is the product of its window, but for that tick's
    own factor."""
    used: int
    """Bit i is set when z_{k-i} has been used."""
    compared: Compared | None


@dataclass(frozen=True)
class Popf:
    """The paper's filter with (28) as (11) derives it.

    `innovation_at_k` takes h(x^-_k) for h(x^-_s), and `covariance_at_k` H_k for H_s, as (28) prints
    them: kept only to show what that costs.

    A measurement may come at any time, in any order, up to `memory` ticks late: M* is taken from
    its own tick on. The derivation takes the errors of measurements that are on their way at the
    same time for independent, so P comes out too small: `popf-exact` does not.
    """

    model: Model
    innovation_at_k: bool = False
    covariance_at_k: bool = False
    memory: int = 1024

    def start(self, x: Vector, P: Matrix) -> PopfState:
        """The prior of tick 0."""
        I = identity(len(x))  # noqa: E741
        window: SlidingProduct[Step, Matrix] = SlidingProduct(_compose, I)
        past = History(window, since=0, older=None, memory=self.memory)
        return PopfState(0, x, P, Belief(x, P), I, past, used=0, compared=None)

    def predict(self, state: PopfState, u: Vector) -> PopfState:
        """(27), and one more factor for (21)."""
        tick, x, P, prior, left, past, used, _ = state
        factor = self.model.A(x, u).dot(left)
        past = past.push(tick, Step(tick, prior, factor), factor)
        used = used << 1 & (1 << self.memory) - 1
        prior = Belief(*self.model.predict(x, P, u))
        return PopfState(tick + 1, *prior, prior, identity(len(x)), past, used, None)

    def correct(
        self, state: PopfState, measurements: Sequence[Measured], inputs: Sequence[Applied] = ()
    ) -> PopfState:
        """(28) for every measurement that is not a repeat and not too old."""
        for s, z in by_sampling(measurements, state.tick):
            lateness = state.tick - s
            if lateness < self.memory and not state.used >> lateness & 1:
                state = self._correct(state, s, z)
        return state

    def _correct(self, state: PopfState, s: int, z: Vector) -> PopfState:
        tick, x, P, prior, left, past, used, _ = state
        past = past.split(at=min(s, tick - 1))
        (x_s, P_s), M = (prior, left) if s == tick else _prior_and_M(past, s, left)
        model, H = self.model, self.model.H(x_s)
        PHt = P_s.dot(H.T)
        K = gain(M.dot(PHt), H.dot(PHt) + model.measurement_noise(x_s))  # (24)
        expected = model.h(prior.x if self.innovation_at_k else x_s)
        x = x + K.dot(model.innovation(z, expected))  # (11)
        H_k = model.H(prior.x)
        seen = H_k.dot(P_s) if self.covariance_at_k else PHt.T
        P = symmetric(P - K.dot(seen).dot(M.T))  # (23)
        left = left - K.dot(H_k).dot(left)
        used |= 1 << tick - s
        return PopfState(tick, x, P, prior, left, past, used, Compared(Belief(x_s, P_s), z))

    def innovation(self, state: PopfState) -> Innovation | None:
        """z_s - h(x^-_s)."""
        return innovation(self.model, state.compared)


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
