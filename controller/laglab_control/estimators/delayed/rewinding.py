"""Any estimator, put right when the inputs turn out to have been others than it was told."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

from laglab_control.estimators.interface import Estimator, InForce, Measured, State
from laglab_control.estimators.kalman import Innovation
from laglab_control.model import Matrix, Vector
from laglab_control.past.log import Log, append, cut, logged
from laglab_control.past.memory import MEMORY

S = TypeVar("S", bound=State)


class Past(NamedTuple, Generic[S]):
    """What was known at a past tick: all that had arrived there, and the input that followed."""

    state: S
    arrived: tuple[Measured, ...]
    u: Vector


class RewindingState(NamedTuple, Generic[S]):
    """The estimator's own state, and the past ticks from which it can be run again."""

    state: S
    arrived: tuple[Measured, ...]
    past: Log[Past[S]]
    """Tick by tick up to the one before."""

    @property
    def tick(self) -> int:
        """k."""
        return self.state.tick

    @property
    def x(self) -> Vector | None:
        """The estimate (d,)."""
        return self.state.x

    @property
    def P(self) -> Matrix | None:
        """Its covariance (d, d)."""
        return self.state.P


@dataclass(frozen=True)
class Rewinding(Estimator[RewindingState[S]]):
    """Goes back to the first input that was wrong, and runs `estimator` again from there.

    The answer is that of an estimator that had known the inputs, and got its measurements when
    they arrived. Inputs that are more than `memory` ticks old stay as they are.
    """

    estimator: Estimator[S]
    memory: int = MEMORY

    def start(self, x: Vector, P: Matrix) -> RewindingState[S]:
        """The prior of tick 0."""
        return RewindingState(self.estimator.start(x, P), (), logged())

    def predict(self, state: RewindingState[S], u: Vector) -> RewindingState[S]:
        """One tick further; what was known before is kept."""
        inner, arrived, past = state
        past = append(past, Past(inner, arrived, u), self.memory)
        return RewindingState(self.estimator.predict(inner, u), (), past)

    def correct(
        self,
        state: RewindingState[S],
        measurements: Sequence[Measured],
        inputs: Sequence[InForce] = (),
    ) -> RewindingState[S]:
        """First the inputs, then the measurements."""
        known = {j: u for j, u in inputs if 0 <= j < state.tick}
        if known:
            state = self._put_right(state, known)
        inner = self.estimator.correct(state.state, measurements)
        return RewindingState(inner, (*state.arrived, *measurements), state.past)

    def expect(self, state: RewindingState[S], s: int) -> RewindingState[S]:
        """The estimator's own."""
        inner, arrived, past = state
        return RewindingState(self.estimator.expect(inner, s), arrived, past)

    def restart(self, state: RewindingState[S], x: Vector, P: Matrix) -> RewindingState[S]:
        """The estimator's own."""
        return RewindingState(self.estimator.restart(state.state, x, P), (), logged())

    @property
    def is_watchable(self) -> bool:
        """As the estimator."""
        return self.estimator.is_watchable

    def innovation(self, state: RewindingState[S]) -> Innovation | None:
        """The estimator's own."""
        return self.estimator.innovation(state.state)

    def warning(self, state: RewindingState[S]) -> str | None:
        """The estimator's own."""
        return self.estimator.warning(state.state)

    def _put_right(
        self, state: RewindingState[S], known: Mapping[int, Vector]
    ) -> RewindingState[S]:
        """Nothing is run again while all is as it was believed."""
        past, length = state.past
        first = state.tick - length
        wrong = [
            j for j, u in known.items() if j >= first and past[j - first].u.tolist() != u.tolist()
        ]
        return self._again(state, min(wrong), known) if wrong else state

    def _again(
        self, state: RewindingState[S], since: int, known: Mapping[int, Vector]
    ) -> RewindingState[S]:
        """From tick `since` to the present."""
        length = state.past.length
        older, undone = cut(state.past, since - (state.tick - length))
        again = RewindingState(undone[0].state, undone[0].arrived, older)
        arrived = [then.arrived for then in undone[1:]] + [state.arrived]
        for then, measurements in zip(undone, arrived, strict=True):
            again = self.predict(again, known.get(then.state.tick, then.u))
            again = self.correct(again, measurements)
        return again
