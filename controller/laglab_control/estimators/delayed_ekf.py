"""`delayed-ekf`: an EKF that lives where the measurements belong, carried on to the present."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, NamedTuple, TypeVar

from laglab_control.estimators import kalman
from laglab_control.estimators.interface import Applied, Estimator, Measured, by_sampling
from laglab_control.estimators.kalman import Belief, Innovation
from laglab_control.estimators.windows import Windows
from laglab_control.model import Matrix, Model, Vector
from laglab_control.past.log import Log, append, cut, logged
from laglab_control.past.sliding import SlidingProduct

W = TypeVar("W")


class Filtered(NamedTuple):
    """One tick of the EKF: the input that led there, prior, what was measured, posterior."""

    tick: int
    u: Vector | None
    prior: Belief
    z: Vector | None
    posterior: Belief
    innovation: Innovation | None


@dataclass(frozen=True, eq=False)
class DelayedState(Generic[W]):
    """The EKF up to the newest measurement's tick, and the inputs from there to `tick`."""

    tick: int
    filtered: Log[Filtered]
    window: SlidingProduct[Vector, W]
    windows: Windows[W]
    innovation: Innovation | None = None
    """Of the newest measurement of this tick's correction."""

    @property
    def x(self) -> Vector:
        """The estimate (d,) at `tick`."""
        return self._carried.x

    @property
    def P(self) -> Matrix:
        """Its covariance (d, d)."""
        return self._carried.P

    @cached_property
    def _carried(self) -> Belief:
        return self.windows.carry(self.filtered.newest.posterior, self.window.product)


@dataclass(frozen=True)
class DelayedEkf(Estimator[DelayedState[W]]):
    """The optimum (to first order) for measurements that come late, in any order, or never.

    Every z_s corrects the EKF at tick s, and what followed is replayed; so the answer is that of
    an EKF that had everything in order. Measurements and corrections of inputs more than `memory`
    ticks older than the newest measurement are not used.
    """

    model: Model
    windows: Windows[W]
    memory: int = 1024

    def start(self, x: Vector, P: Matrix) -> DelayedState[W]:
        """The prior of tick 0."""
        prior = Belief(x, P)
        first = Filtered(0, None, prior, None, prior, None)
        window: SlidingProduct[Vector, W] = SlidingProduct(
            self.windows.compose, self.windows.identity
        )
        return DelayedState(0, logged(first), window, self.windows)

    def predict(self, state: DelayedState[W], u: Vector) -> DelayedState[W]:
        """One more input in the window; the EKF stays at most `memory` ticks behind."""
        tick = state.tick + 1
        window = state.window.push(u, state.windows.over(u))
        predicted = DelayedState(tick, state.filtered, window, state.windows)
        return self._advance(predicted, tick - self.memory, None, {})

    def correct(
        self,
        state: DelayedState[W],
        measurements: Sequence[Measured],
        inputs: Sequence[Applied] = (),
    ) -> DelayedState[W]:
        """Roll back to the oldest news, replay from there, then go on to the newest measurement."""
        measurements = by_sampling(measurements, state.tick)
        newest = state.filtered.newest.tick
        oldest = newest - min(state.filtered.length - 1, self.memory)
        known = {j + 1: u for j, u in inputs if oldest <= j < state.tick}
        late = {s: z for s, z in reversed(measurements) if oldest <= s <= newest}
        late_known = {tick: u for tick, u in known.items() if tick <= newest}
        if late or late_known:
            state = self._revise(state, late, late_known)
        for s, z in measurements:
            state = self._advance(state, s, z, known)
        window = self._put_right(state, known)
        if not measurements:
            return DelayedState(state.tick, state.filtered, window, state.windows)
        innovation = _innovation(state.filtered, measurements[-1].tick)
        return DelayedState(state.tick, state.filtered, window, state.windows, innovation)

    def innovation(self, state: DelayedState[W]) -> Innovation | None:
        """z_s - h(x^-_s), with the prior that the EKF has at s by now."""
        return state.innovation

    def _advance(
        self, state: DelayedState[W], s: int, z: Vector | None, known: Mapping[int, Vector]
    ) -> DelayedState[W]:
        """Bring the EKF up to tick s > its own, and correct it there."""
        filtered, window = state.filtered, state.window
        tick = filtered.newest.tick
        if tick >= s:
            return state
        while tick < s:
            u, window = window.pop()
            tick += 1
            filtered = self._extend(filtered, known.get(tick, u), z if tick == s else None)
        return DelayedState(state.tick, filtered, window, state.windows)

    def _put_right(
        self, state: DelayedState[W], known: Mapping[int, Vector]
    ) -> SlidingProduct[Vector, W]:
        """The window with those of its inputs that were wrong put right; `known` by the tick that
        each led to."""
        newest = state.filtered.newest.tick
        if all(tick <= newest for tick in known):
            return state.window
        window = state.window.emptied()
        for tick, u in enumerate(state.window, start=newest + 1):
            right = known.get(tick, u)
            window = window.push(right, state.windows.over(right))
        return window

    def _extend(self, filtered: Log[Filtered], u: Vector, z: Vector | None) -> Log[Filtered]:
        newest = filtered.newest
        prior = Belief(*self.model.predict(*newest.posterior, u))
        return append(filtered, self._corrected(newest.tick + 1, u, prior, z), self.memory)

    def _corrected(self, tick: int, u: Vector | None, prior: Belief, z: Vector | None) -> Filtered:
        if z is None:
            return Filtered(tick, u, prior, None, prior, None)
        return Filtered(tick, u, prior, z, *kalman.correct(self.model, prior, z))

    def _revise(
        self, state: DelayedState[W], late: Mapping[int, Vector], known: Mapping[int, Vector]
    ) -> DelayedState[W]:
        """With measurements and inputs (by the tick they led to) that came after the EKF passed."""
        log = state.filtered
        oldest = log.newest.tick - (log.length - 1)
        filtered, undone = cut(log, max(min({*late, *known}) - oldest, 0))
        for past in undone:
            z = late.get(past.tick) if past.z is None else past.z
            u = known.get(past.tick, past.u)
            if filtered.length == 0 or u is None:
                filtered = logged(self._corrected(past.tick, u, past.prior, z))
            else:
                filtered = self._extend(filtered, u, z)
        return DelayedState(state.tick, filtered, state.window, state.windows)


def _innovation(filtered: Log[Filtered], s: int) -> Innovation | None:
    """At tick s, as it is by now; None where nothing was measured, or it is no longer kept."""
    items, length = filtered
    index = length - 1 - (items[length - 1].tick - s)
    return items[index].innovation if index >= 0 else None
