"""`popf`: the paper's past-observation predictive filter (27), (28)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from laglab_controller import kalman
from laglab_controller.estimator import Applied, Measured
from laglab_controller.kalman import Belief
from laglab_controller.log import Log, append, newest_first
from laglab_controller.model import Matrix, Model, Vector
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
    """I - K_k H_k of the corrections made so far at this tick; I before the first."""
    window: SlidingProduct[Step, Matrix]
    """The ticks since the newest measurement's, whose product is M* but for that tick's factor."""
    since: int
    """The oldest tick in `window`."""
    older: Log[Step] | None
    """The ticks before `since`."""
    used: int
    """Bit i is set when z_{k-i} has been used."""


@dataclass(frozen=True)
class Popf:
    """The paper's filter with (28) as (11) derives it; `innovation_at_k` prints it as (28) does.

    A measurement may come at any time, in any order, up to `memory` ticks late: M* is taken from
    its own tick on. The equations take two measurements for independent of each other's
    corrections, so those on the way at the same time make P too small: see `popf-exact`.
    """

    model: Model
    innovation_at_k: bool = False
    memory: int = 1024

    def start(self, x: Vector, P: Matrix) -> PopfState:
        """The prior of tick 0."""
        identity = np.eye(len(x))
        window: SlidingProduct[Step, Matrix] = SlidingProduct(_compose, identity)
        return PopfState(
            0, x, P, Belief(x, P), left=identity, window=window, since=0, older=None, used=0
        )

    def predict(self, state: PopfState, u: Vector) -> PopfState:
        """(27), and one more factor for (21)."""
        prior, A = kalman.predict(self.model, Belief(state.x, state.P), u)
        step = Step(state.tick, state.prior, A @ state.left)
        predicted = state._replace(
            tick=state.tick + 1,
            x=prior.x,
            P=prior.P,
            prior=prior,
            left=state.window.identity,
            window=state.window.push(step, step.factor),
            used=state.used << 1 & (1 << self.memory) - 1,
        )
        return self._slide(predicted, to=predicted.tick - self.memory)

    def correct(
        self, state: PopfState, measurements: Sequence[Measured], inputs: Sequence[Applied] = ()
    ) -> PopfState:
        """(28) for every measurement that is not a repeat and not too old."""
        for s, z in measurements:
            lateness = state.tick - s
            if lateness < self.memory and not state.used >> lateness & 1:
                state = self._correct(self._slide(state, to=s), s, z)
        return state

    def _slide(self, state: PopfState, to: int) -> PopfState:
        """Leave in the window only the ticks after `to`."""
        window, since, older = state.window, state.since, state.older
        while since <= min(to, state.tick - 1):
            step, window = window.pop()
            older = append(older, step, self.memory)
            since += 1
        return state._replace(window=window, since=since, older=older)

    def _correct(self, state: PopfState, s: int, z: Vector) -> PopfState:
        model, (x_s, P_s), M = self.model, *_prior_and_M(state, s)
        H = model.H(x_s)
        K = kalman.gain(M @ P_s @ H.T, H @ P_s @ H.T + model.measurement_noise(x_s))  # (24)
        expected = model.h(state.prior.x if self.innovation_at_k else x_s)
        left = state.left - K @ model.H(state.prior.x) @ state.left
        return state._replace(
            x=state.x + K @ model.innovation(z, expected),  # (11)
            P=kalman.symmetric(state.P - K @ H @ P_s @ M.T),  # (23)
            left=left,
            used=state.used | 1 << state.tick - s,
        )


def _prior_and_M(state: PopfState, s: int) -> tuple[Belief, Matrix]:
    """The prior of tick s, and M* (21) from there to this tick and its corrections so far."""
    if s == state.tick:
        return state.prior, state.left
    M = state.left @ state.window.product
    for step in newest_first(state.older):
        M = M @ step.factor
        if step.tick == s:
            return step.prior, M
    raise IndexError(f"tick {s} is no longer kept")


def _compose(older: Matrix, newer: Matrix) -> Matrix:
    """Later factors of (21) stand to the left."""
    return newer @ older
