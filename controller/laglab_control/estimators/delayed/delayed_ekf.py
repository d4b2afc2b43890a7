"""`delayed-ekf`: an EKF that lives where the measurements belong, carried on to the present."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, NamedTuple, TypeVar

from laglab_control.estimators import kalman
from laglab_control.estimators.delayed.windows import Windows
from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Belief, Innovation
from laglab_control.model import Matrix, Model, Vector
from laglab_control.past.log import Log, append, cut, logged
from laglab_control.past.memory import MEMORY
from laglab_control.past.sliding import SlidingProduct

W = TypeVar("W")
Window = SlidingProduct[Vector, W]


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
    window: Window[W]
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
    memory: int = MEMORY

    def start(self, x: Vector, P: Matrix) -> DelayedState[W]:
        """The prior of tick 0."""
        prior = Belief(x, P)
        first = Filtered(0, None, prior, None, prior, None)
        window: Window[W] = SlidingProduct(self.windows.compose, self.windows.identity)
        return DelayedState(0, logged(first), window, self.windows)

    def predict(self, state: DelayedState[W], u: Vector) -> DelayedState[W]:
        """One more input in the window; the EKF stays at most `memory` ticks behind."""
        tick = state.tick + 1
        window = state.window.push(u, state.windows.over(u))
        filtered, window = self._advance(state.filtered, window, tick - self.memory, None, {})
        return DelayedState(tick, filtered, window, state.windows)

    def correct(
        self,
        state: DelayedState[W],
        measurements: Sequence[Measured],
        inputs: Sequence[InForce] = (),
    ) -> DelayedState[W]:
        """Roll back to the oldest news, replay from there, then go on to the newest measurement."""
        measurements = by_sampling(measurements, state.tick)
        filtered, window = state.filtered, state.window
        newest = filtered.newest.tick
        oldest = max(newest - self.memory, 0)
        known = {j + 1: u for j, u in inputs if oldest <= j < state.tick} if inputs else {}
        if (known and min(known) <= newest) or (measurements and measurements[0].tick <= newest):
            late = {s: z for s, z in reversed(measurements) if oldest <= s <= newest}
            filtered = self._revise(filtered, late, known)
        for s, z in measurements:
            filtered, window = self._advance(filtered, window, s, z, known)
        if known and max(known) > filtered.newest.tick:
            window = _put_right(state.windows, filtered.newest.tick, window, known)
        innovation = _innovation(filtered, measurements[-1].tick) if measurements else None
        return DelayedState(state.tick, filtered, window, state.windows, innovation)

    def innovation(self, state: DelayedState[W]) -> Innovation | None:
        """z_s - h(x^-_s), with the prior that the EKF has at s by now."""
        return state.innovation

    def _advance(
        self,
        filtered: Log[Filtered],
        window: Window[W],
        s: int,
        z: Vector | None,
        known: Mapping[int, Vector],
    ) -> tuple[Log[Filtered], Window[W]]:
        """Bring the EKF up to tick s > its own, and correct it there."""
        tick = filtered.newest.tick
        while tick < s:
            u, window = window.pop()
            tick += 1
            filtered = self._extend(filtered, known.get(tick, u), z if tick == s else None)
        return filtered, window

    def _extend(self, filtered: Log[Filtered], u: Vector, z: Vector | None) -> Log[Filtered]:
        newest = filtered.newest
        prior = Belief(*self.model.predict(*newest.posterior, u))
        return append(filtered, self._corrected(newest.tick + 1, u, prior, z), self.memory)

    def _corrected(self, tick: int, u: Vector | None, prior: Belief, z: Vector | None) -> Filtered:
        if z is None:
            return Filtered(tick, u, prior, None, prior, None)
        return Filtered(tick, u, prior, z, *kalman.correct(self.model, prior, z))

    def _revise(
        self, log: Log[Filtered], late: Mapping[int, Vector], known: Mapping[int, Vector]
    ) -> Log[Filtered]:
        """With measurements and inputs (by the tick they led to) that came after the EKF passed."""
        passed = [tick for tick in (*late, *known) if tick <= log.newest.tick]
        if not passed:
            return log
        oldest = log.newest.tick - (log.length - 1)
        filtered, undone = cut(log, max(min(passed) - oldest, 0))
        for past in undone:
            z = late.get(past.tick) if past.z is None else past.z
            u = known.get(past.tick, past.u)
            if filtered.length == 0 or u is None:
                filtered = logged(self._corrected(past.tick, u, past.prior, z))
            else:
                filtered = self._extend(filtered, u, z)
        return filtered


def _put_right(
    windows: Windows[W], newest: int, window: Window[W], known: Mapping[int, Vector]
) -> Window[W]:
    """The window from tick `newest` on with those of its inputs that were wrong put right;
    `known` by the tick that each led to."""
    right = window.emptied()
    for tick, u in enumerate(window, start=newest + 1):
        told = known.get(tick, u)
        right = right.push(told, windows.over(told))
    return right


def _innovation(filtered: Log[Filtered], s: int) -> Innovation | None:
    """At tick s, as it is by now; None where nothing was measured, or it is no longer kept."""
    items, length = filtered
    index = length - 1 - (items[length - 1].tick - s)
    return items[index].innovation if index >= 0 else None
