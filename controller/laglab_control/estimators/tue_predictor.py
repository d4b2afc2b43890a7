"""`tue-predictor`: a copy of the robot that is pulled to where the robot was seen to have been.

After A. Alvarez-Aguirre, N. van de Wouw, T. Oguchi, H. Nijmeijer, "Predictor-based remote tracking
control of a mobile robot", IEEE Transactions on Control Systems Technology 22 (6), 2014; what of it
this is, and what it is not, is told in docs/theory.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from laglab_control.angle import direction, wrap
from laglab_control.estimators.interface import Estimator, InForce, Measured, by_sampling
from laglab_control.estimators.kalman import Innovation
from laglab_control.limits import Positive, check
from laglab_control.model import Matrix, Vector
from laglab_control.past.log import Log, append, logged
from laglab_control.past.memory import MEMORY
from laglab_control.robot import RobotModel


class TueState(NamedTuple):
    """The copy's pose x (3,) at `tick`, and where it has been."""

    tick: int
    x: Vector
    newest: int
    """When the newest measurement by which it was corrected was sampled."""
    past: Log[Vector]
    """Its poses up to this tick, each as it was before it was corrected there."""

    @property
    def P(self) -> None:
        """Nothing is claimed."""
        return


@dataclass(frozen=True)
class TuePredictor(Estimator[TueState]):
    """x_{k+1} = f(x_k, u_k), and for a measurement of tick s, in the frame of the copy:
    x_k + Ts K (z_s - x_s), where x_s is the pose that the copy had then.

    The gains are in 1/s, forward, aside and of the heading. With a constant delay of m ticks the
    error shrinks if Ts K < 2 sin(pi / (2 (2 m + 1))). Raises ConfigError, naming the field, for a
    gain that cannot be.
    """

    model: RobotModel
    k_x: Positive = 2.0
    k_y: Positive = 2.0
    k_theta: Positive = 2.0

    def __post_init__(self) -> None:
        check(self)

    def start(self, x: Vector, P: Matrix) -> TueState:
        """Where the robot is said to be."""
        return TueState(0, x, -1, logged(x))

    def predict(self, state: TueState, u: Vector) -> TueState:
        """The copy does what the robot does."""
        tick, x, newest, past = state
        there = self.model.f(x, u)
        return TueState(tick + 1, there, newest, append(past, there, MEMORY))

    def correct(
        self, state: TueState, measurements: Sequence[Measured], inputs: Sequence[InForce] = ()
    ) -> TueState:
        """By each measurement that is newer than all before; it has no past to put right."""
        for s, z in by_sampling(measurements, state.tick):
            if s > state.newest:
                state = self._pulled(state, s, z)
        return state

    def _pulled(self, state: TueState, s: int, z: Vector) -> TueState:
        tick, x, _, past = state
        index = past.length - 1 - (tick - s)
        if index < 0:
            return state
        ahead, aside, turn = _seen_from(past.items[index], z)
        Ts = self.model.sample_time
        forward, sideways = Ts * self.k_x * ahead, Ts * self.k_y * aside
        cosine, sine = direction(float(x[2]))
        pull = (
            cosine * forward - sine * sideways,
            sine * forward + cosine * sideways,
            Ts * self.k_theta * turn,
        )
        return TueState(tick, x + np.array(pull), s, past)

    @property
    def is_watchable(self) -> bool:
        """It weighs nothing, so nothing is wild."""
        return False

    def innovation(self, state: TueState) -> Innovation | None:
        """It weighs nothing."""
        return None


def _seen_from(pose: Vector, z: Vector) -> tuple[float, float, float]:
    """z less the pose, in the frame of the pose."""
    dx, dy, turn = (z - pose).tolist()
    cosine, sine = direction(float(pose[2]))
    return cosine * dx + sine * dy, -sine * dx + cosine * dy, wrap(turn)
