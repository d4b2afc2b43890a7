"""Any estimator, put right when the inputs turn out to have been others than it was told."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

from laglab_controller.estimator import Applied, Estimator, Measured, State
from laglab_controller.history import History
from laglab_controller.kalman import Innovation
from laglab_controller.model import Matrix, Vector
from laglab_controller.sliding import SlidingProduct

S = TypeVar("S", bound=State)


class Tick(NamedTuple, Generic[S]):
    """What was known at a past tick: all that had arrived there, and the input that followed."""

    tick: int
    state: S
    arrived: tuple[Measured, ...]
    u: Vector


class RewindingState(NamedTuple, Generic[S]):
    """The estimator's own state, and the past ticks from which it can be run again."""

    state: S
    arrived: tuple[Measured, ...]
    history: History[Tick[S], None]

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
class Rewinding(Generic[S]):
    """Goes back to the first input that was wrong, and runs `estimator` again from there.

    The answer is that of an estimator that had known the inputs, and got its measurements when
    they arrived. Inputs that are more than `memory` ticks old stay as they are.
    """

    estimator: Estimator[S]
    memory: int = 1024

    def start(self, x: Vector, P: Matrix) -> RewindingState[S]:
        """The prior of tick 0."""
        nothing: SlidingProduct[Tick[S], None] = SlidingProduct(_nothing, None)
        history = History(nothing, since=0, older=None, memory=self.memory)
        return RewindingState(self.estimator.start(x, P), (), history)

    def predict(self, state: RewindingState[S], u: Vector) -> RewindingState[S]:
        """One tick further; what was known before is kept."""
        inner, arrived, history = state
        history = history.push(inner.tick, Tick(inner.tick, inner, arrived, u), None)
        return RewindingState(self.estimator.predict(inner, u), (), history)

    def correct(
        self,
        state: RewindingState[S],
        measurements: Sequence[Measured],
        inputs: Sequence[Applied] = (),
    ) -> RewindingState[S]:
        """First the inputs, then the measurements."""
        known = {j: u for j, u in inputs if 0 <= j < state.tick}
        if known:
            state = self._put_right(state, known)
        inner = self.estimator.correct(state.state, measurements)
        return RewindingState(inner, (*state.arrived, *measurements), state.history)

    def expect(self, state: RewindingState[S], s: int) -> RewindingState[S]:
        """The estimator's own."""
        inner, arrived, history = state
        return RewindingState(self.estimator.expect(inner, s), arrived, history)

    def innovation(self, state: RewindingState[S]) -> Innovation | None:
        """The estimator's own."""
        return self.estimator.innovation(state.state)

    def _put_right(
        self, state: RewindingState[S], known: Mapping[int, Vector]
    ) -> RewindingState[S]:
        """Nothing is run again while all is as it was believed."""
        inner, arrived, history = state
        history = history.split(max(known))
        oldest, past, wrong = min(known), [], 0
        for then in history.backwards():
            past.append(then)
            u = known.get(then.tick)
            if u is not None and u.tolist() != then.u.tolist():
                wrong = len(past)
            if then.tick <= oldest:
                break
        state = RewindingState(inner, arrived, history)
        return self._again(state, past[:wrong], known) if wrong else state

    def _again(
        self, state: RewindingState[S], undone: list[Tick[S]], known: Mapping[int, Vector]
    ) -> RewindingState[S]:
        """From the oldest of `undone`, which are given newest first, to the present."""
        history = state.history
        past = [*reversed(undone), *history.window]
        older = history.older
        for _ in undone:
            assert older is not None
            older = older.older
        first = past[0]
        again = RewindingState(
            first.state,
            first.arrived,
            History(history.window.emptied(), first.tick, older, self.memory),
        )
        arrived = [then.arrived for then in past[1:]] + [state.arrived]
        for then, measurements in zip(past, arrived, strict=True):
            again = self.predict(again, known.get(then.tick, then.u))
            again = self.correct(again, measurements)
        return again


def _nothing(_older: None, _newer: None) -> None:
    return None
