"""`calibrating-ekf`: `delayed-ekf` of the pose and of what the robot's model has wrong."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from laglab_control.estimators.calibrated import CalibratedMotions, CalibratedRobot, Learned
from laglab_control.estimators.delayed_ekf import DelayedEkf, DelayedState
from laglab_control.estimators.interface import Applied, Estimator, Measured
from laglab_control.estimators.kalman import Innovation
from laglab_control.estimators.parameters import Parameters
from laglab_control.model import Matrix, Vector
from laglab_control.robot import RobotModel, Ways


class CalibratingState(NamedTuple):
    """The delayed filter of [x, y, theta, b_1 ... b_p]; b is at the newest measurement's tick."""

    joint: DelayedState[Learned]
    motions: CalibratedMotions

    @property
    def tick(self) -> int:
        """k."""
        return self.joint.tick

    @property
    def x(self) -> Vector:
        """The pose (3,)."""
        return self.joint.x

    @property
    def P(self) -> Matrix:
        """Its covariance (3, 3)."""
        return self.joint.P

    @property
    def parameters(self) -> Vector:
        """b (p,)."""
        return self.joint.filtered.newest.posterior.x[3:]

    @property
    def parameters_covariance(self) -> Matrix:
        """(p, p)."""
        return self.joint.filtered.newest.posterior.P[3:, 3:]


@dataclass(frozen=True)
class CalibratingEkf(Estimator[CalibratingState]):
    """An EKF of the pose x and of parameters b that walk at random, delayed as `delayed-ekf` is."""

    robot: RobotModel
    parameters: Parameters
    memory: int = 1024
    tolerance: float = 0.01
    """The windows are linearised anew as soon as some b is further than this from where they were.
    """

    @cached_property
    def _ekf(self) -> DelayedEkf[Learned]:
        nominal = CalibratedMotions(
            self.robot, self.parameters, (0.0,) * len(self.parameters.deviations)
        )
        return DelayedEkf(CalibratedRobot(self.robot, self.parameters), nominal, self.memory)

    def start(self, x: Vector, P: Matrix) -> CalibratingState:
        b = np.zeros(len(self.parameters.deviations))
        return self._start(x, P, b, np.diag(np.square(self.parameters.deviations)))

    def restart(self, state: CalibratingState, x: Vector, P: Matrix) -> CalibratingState:
        return self._start(x, P, state.parameters, state.parameters_covariance)

    def _start(self, x, P, b, B):
        joint = np.zeros((3 + len(b),) * 2)
        joint[:3, :3], joint[3:, 3:] = P, B
        begun = self._ekf.start(np.append(x, b), joint)
        return self._linearised(CalibratingState(begun, self._ekf.windows))

    def predict(self, state: CalibratingState, u: Vector) -> CalibratingState:
        return CalibratingState(self._ekf.predict(state.joint, u), state.motions)

    def correct(
        self,
        state: CalibratingState,
        measurements: Sequence[Measured],
        inputs: Sequence[Applied] = (),
    ) -> CalibratingState:
        joint = self._ekf.correct(state.joint, measurements, inputs)
        return self._linearised(CalibratingState(joint, state.motions))

    def innovation(self, state: CalibratingState) -> Innovation | None:
        return self._ekf.innovation(state.joint)

    def calibrated(self, state: CalibratingState, robot: Ways) -> Ways:
        return state.motions

    def _linearised(self, state: CalibratingState) -> CalibratingState:
        """At the b of now, if it has moved."""
        b = state.joint.filtered.newest.posterior.x.tolist()[3:]
        for value, at in zip(b, state.motions.at, strict=True):
            if not abs(value - at) <= self.tolerance:
                motions = CalibratedMotions(self.robot, self.parameters, b)
                return CalibratingState(replace(state.joint, windows=motions), motions)
        return state
