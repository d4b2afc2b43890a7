"""`ekf`: the extended Kalman filter that takes a late measurement for a fresh one, as in `fig8`."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from laglab_control.estimators import kalman
from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Belief, Innovation
from laglab_control.model import Matrix, Model, Vector


class EkfState(NamedTuple):
    """The estimate x (d,) and covariance P (d, d) at `tick`; when the `newest` z was sampled."""

    tick: int
    x: Vector
    P: Matrix
    newest: int
    innovation: Innovation | None


@dataclass(frozen=True)
class Ekf(Estimator[EkfState]):
    """(27) and (8), blind to the delay: z_s is taken for z_k. With m = 0 it is right."""

    model: Model

    def start(self, x: Vector, P: Matrix) -> EkfState:
        """The prior of tick 0."""
        return EkfState(0, x, P, newest=-1, innovation=None)

    def predict(self, state: EkfState, u: Vector) -> EkfState:
        """(27)."""
        x, P = self.model.predict(state.x, state.P, u)
        return EkfState(state.tick + 1, x, P, state.newest, innovation=None)

    def correct(
        self, state: EkfState, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> EkfState:
        """(8) for every measurement newer than all before; it has no past to correct."""
        tick, x, P, newest, innovation = state
        for s, z in by_sampling(measurements, tick):
            if s > newest:
                (x, P), innovation = kalman.correct(self.model, Belief(x, P), z)
                newest = s
        return EkfState(tick, x, P, newest, innovation)

    def innovation(self, state: EkfState) -> Innovation | None:
        """z_s - h(x^-_k)."""
        return state.innovation
