"""`ekf`: the extended Kalman filter that takes a late measurement for a fresh one (Fig. 8)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from laglab_controller import kalman
from laglab_controller.estimator import Applied, Measured
from laglab_controller.kalman import Belief
from laglab_controller.model import Matrix, Model, Vector


class EkfState(NamedTuple):
    """The estimate x (d,) and covariance P (d, d) at `tick`; when `newest` was sampled."""

    tick: int
    x: Vector
    P: Matrix
    newest: int


@dataclass(frozen=True)
class Ekf:
    """(27) and (8), blind to the delay: z_s is taken for z_k. With m = 0 it is right."""

    model: Model

    def start(self, x: Vector, P: Matrix) -> EkfState:
        """The prior of tick 0."""
        return EkfState(0, x, P, newest=-1)

    def predict(self, state: EkfState, u: Vector) -> EkfState:
        """(27)."""
        return EkfState(state.tick + 1, *self.model.predict(state.x, state.P, u), state.newest)

    def correct(
        self, state: EkfState, measurements: Sequence[Measured], inputs: Sequence[Applied] = ()
    ) -> EkfState:
        """(8) for every measurement newer than all before; it has no past to correct."""
        tick, x, P, newest = state
        for s, z in measurements:
            if s > newest:
                x, P = kalman.correct(self.model, Belief(x, P), z)
                newest = s
        return EkfState(tick, x, P, newest)
