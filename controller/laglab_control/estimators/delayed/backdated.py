"""Any filter that knows nothing of delays, made one that does: it goes back to where a measurement
belongs, and runs again from there."""

from abc import abstractmethod
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from laglab_control.errors import PluginFailedError
from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Innovation
from laglab_control.model import Matrix, Vector
from laglab_control.plugins import shown
from laglab_control.robot import RobotModel

WINDOW = 256
"""Ticks that are kept; what was measured before is not used."""


class PastTick(NamedTuple):
    """One tick, before its measurement."""

    x: Vector
    P: Matrix
    u: Vector | None = None
    """In force from then on; None at the present."""
    z: Vector | None = None
    """None: nothing was measured, or it has not come yet."""


class BackdatedState(NamedTuple):
    """Immutable."""

    tick: int
    x: Vector
    P: Matrix
    past: tuple[PastTick, ...]
    """The present one last."""
    innovation: Innovation | None


class Backdated(Estimator[BackdatedState]):
    """To be derived from: `forward` and `corrected` are what the filter does without delays.

    A tick costs as much as the filter takes for all ticks since the measurement that came; a
    library's filter is often slow enough for that to matter (`laglab check`).
    """

    def __init__(self, model: RobotModel) -> None:
        self.model = model

    @abstractmethod
    def forward(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """x (d,) and P (d, d) one tick later, with the input u = [v, omega] (2,) in force."""

    @abstractmethod
    def corrected(self, x: Vector, P: Matrix, z: Vector) -> tuple[Vector, Matrix]:
        """x (d,) and P (d, d) after a measurement z of the pose (3,)."""

    def start(self, x: Vector, P: Matrix) -> BackdatedState:
        """At tick 0."""
        return BackdatedState(0, x, P, (PastTick(x, P),), None)

    def predict(self, state: BackdatedState, u: Vector) -> BackdatedState:
        """One tick further."""
        x, P = _answered("forward", self.forward(state.x, state.P, u))
        past = (*state.past[-WINDOW:-1], state.past[-1]._replace(u=u), PastTick(x, P))
        return BackdatedState(state.tick + 1, x, P, past, None)

    def correct(
        self,
        state: BackdatedState,
        measurements: Sequence[Measured],
        inputs: Sequence[InForce] = (),
    ) -> BackdatedState:
        """Again from the oldest tick of which something new is known. Raises StampError."""
        past, first = list(state.past), state.tick + 1 - len(state.past)
        new: list[int] = []
        for tick, u in inputs:
            if first <= tick < state.tick:
                past[tick - first] = past[tick - first]._replace(u=u)
                new.append(tick - first)
        newest = None
        for tick, z in by_sampling(measurements, state.tick):
            if tick >= first and past[tick - first].z is None:
                newest = tick - first
                past[newest] = past[newest]._replace(z=z)
                new.append(newest)
        return self._again(state.tick, past, min(new), newest) if new else state

    def innovation(self, state: BackdatedState) -> Innovation | None:
        """z - x and P + R of the pose, as they were before the newest measurement was used."""
        return state.innovation

    def _again(
        self, tick: int, past: list[PastTick], since: int, newest: int | None
    ) -> BackdatedState:
        x, P, innovation = past[since].x, past[since].P, None
        for i in range(since, len(past)):
            past[i] = here = past[i]._replace(x=x, P=P)
            if here.z is not None:
                if i == newest:
                    S = P[:3, :3] + self.model.R
                    innovation = Innovation(self.model.innovation(here.z, x[:3]), S)
                x, P = _answered("corrected", self.corrected(x, P, here.z))
            if here.u is not None:
                x, P = _answered("forward", self.forward(x, P, here.u))
        return BackdatedState(tick, x, P, tuple(past), innovation)


def _answered(method: str, answer: tuple[Vector, Matrix]) -> tuple[Vector, Matrix]:
    """What `method` has made of x and P. Raises PluginFailedError: they are no arrays."""
    try:
        x, P = answer
    except Exception:  # it is no pair, or has an __iter__ of its own
        raise _wrong(method, "x (d,) and P (d, d)", answer) from None
    if not (isinstance(x, np.ndarray) and x.ndim == 1):
        raise _wrong(method, "x as an array (d,)", x)
    if not (isinstance(P, np.ndarray) and P.shape == (len(x), len(x))):
        raise _wrong(method, f"P as an array {(len(x), len(x))}", P)
    return x, P


def _wrong(method: str, wanted: str, answer: object) -> PluginFailedError:
    return PluginFailedError(f"{method} must answer {wanted}, not {shown(answer)}")
