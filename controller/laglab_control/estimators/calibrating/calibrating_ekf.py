"""`calibrating-ekf`: `delayed-ekf` of the pose and of what the model of the robot has wrong."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from laglab_control.estimators.calibrating.calibrated import (
    CalibratedMotions,
    CalibratedRobot,
    Learned,
)
from laglab_control.estimators.calibrating.parameters import Parameters
from laglab_control.estimators.delayed.delayed_ekf import DelayedEkf, DelayedState
from laglab_control.estimators.interface import Calibration, Estimator, InForce, Measured
from laglab_control.estimators.kalman import Belief, Innovation
from laglab_control.model import Matrix, Vector
from laglab_control.past.memory import MEMORY
from laglab_control.robot import RobotModel, Ways


class CalibratingState(NamedTuple):
    """What `delayed-ekf` knows of x and b together, and what carries it to the present."""

    joint: DelayedState[Learned]
    motions: CalibratedMotions

    @property
    def tick(self) -> int:
        """k."""
        return self.joint.tick

    @property
    def x(self) -> Vector:
        """The pose (3,) at `tick`."""
        return self.joint.x

    @property
    def P(self) -> Matrix:
        """Its covariance (3, 3)."""
        return self.joint.P

    @property
    def parameters(self) -> Belief:
        """b (p,) and its covariance (p, p), as of the newest measurement."""
        x, P = self.joint.filtered.newest.posterior
        return Belief(x[3:], P[3:, 3:])


@dataclass(frozen=True, eq=False)
class CalibratingEkf(Estimator[CalibratingState]):
    """An EKF of [x, y, theta, b_1 ... b_p] where the measurements belong, carried to the present.

    The EKF is linearised at its own b; the windows that carry it at one that is within `tolerance`
    of it when an input comes in.
    """

    robot: RobotModel
    parameters: Parameters
    memory: int = MEMORY
    tolerance: float = 0.01

    def start(self, x: Vector, P: Matrix) -> CalibratingState:
        """The prior of tick 0, with b = 0 as surely as `parameters` say."""
        deviations = np.array(self.parameters.deviations)
        return self._from(x, P, Belief(np.zeros(len(deviations)), np.diag(deviations**2)))

    def restart(self, state: CalibratingState, x: Vector, P: Matrix) -> CalibratingState:
        """The prior of tick 0, with b as it is known by now."""
        return self._from(x, P, state.parameters)

    def predict(self, state: CalibratingState, u: Vector) -> CalibratingState:
        """As `delayed-ekf` does."""
        return CalibratingState(self._ekf.predict(state.joint, u), state.motions)

    def correct(
        self,
        state: CalibratingState,
        measurements: Sequence[Measured],
        inputs: Sequence[InForce] = (),
    ) -> CalibratingState:
        """As `delayed-ekf` does."""
        joint = self._ekf.correct(state.joint, measurements, inputs)
        return self._linearised(CalibratingState(joint, state.motions))

    def innovation(self, state: CalibratingState) -> Innovation | None:
        """As `delayed-ekf` has it."""
        return state.joint.innovation

    def calibrated(self, state: CalibratingState, robot: Ways) -> Ways:
        """The robot with b as it is known by now, to `tolerance`."""
        return state.motions

    def learned(self, state: CalibratingState) -> tuple[Calibration, ...]:
        """Each b."""
        b, P = state.parameters
        deviations = np.sqrt(np.diag(P)).tolist()
        known = zip(self.parameters.names, b.tolist(), deviations, strict=True)
        return tuple(Calibration(*each) for each in known)

    @cached_property
    def model(self) -> CalibratedRobot:
        """Of x and b together."""
        return CalibratedRobot(self.robot, self.parameters)

    @cached_property
    def _ekf(self) -> DelayedEkf[Learned]:
        nominal = [0.0] * len(self.parameters.deviations)
        motions = CalibratedMotions(self.robot, self.parameters, nominal)
        return DelayedEkf(self.model, motions, self.memory)

    def _from(self, x: Vector, P: Matrix, b: Belief) -> CalibratingState:
        size = len(x) + len(b.x)
        joint = np.zeros((size, size))
        joint[:3, :3], joint[3:, 3:] = P, b.P
        motions = CalibratedMotions(self.robot, self.parameters, b.x.tolist())
        begun = self._ekf.start(np.concatenate((x, b.x)), joint)
        return CalibratingState(replace(begun, windows=motions), motions)

    def _linearised(self, state: CalibratingState) -> CalibratingState:
        """For the inputs to come, at b as it is known by now."""
        joint, motions = state
        b = joint.filtered.newest.posterior.x.tolist()[3:]
        for value, at in zip(b, motions.at, strict=True):
            if not abs(value - at) <= self.tolerance:
                motions = CalibratedMotions(self.robot, self.parameters, b)
                return CalibratingState(replace(joint, windows=motions), motions)
        return state
