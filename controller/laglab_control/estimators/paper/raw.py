"""No filter at all: what `fig5` shows to be not enough."""

from collections.abc import Sequence
from typing import NamedTuple

from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Innovation
from laglab_control.model import Matrix, Vector


class RawState(NamedTuple):
    """`x` is the newest measurement, None before the first; `newest` the tick of its sampling."""

    tick: int
    x: Vector | None
    newest: int

    @property
    def P(self) -> None:
        """Nothing is claimed."""
        return


class Raw(Estimator[RawState]):
    """Takes the newest measurement for the state, and predicts nothing."""

    def start(self, x: Vector, P: Matrix) -> RawState:
        """Knows nothing."""
        return RawState(tick=0, x=None, newest=-1)

    def predict(self, state: RawState, u: Vector) -> RawState:
        """The same one tick later."""
        tick, x, newest = state
        return RawState(tick + 1, x, newest)

    def correct(
        self, state: RawState, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> RawState:
        """The newest measurement; those older than one already seen are of no use to it."""
        for tick, z in by_sampling(measurements, state.tick):
            if tick > state.newest:
                state = RawState(state.tick, z, tick)
        return state

    @property
    def is_watchable(self) -> bool:
        """It expects nothing, so nothing is wild."""
        return False

    def innovation(self, state: RawState) -> Innovation | None:
        """It expects nothing."""
        return None
