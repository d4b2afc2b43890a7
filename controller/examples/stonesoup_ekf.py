"""Stone Soup's extended Kalman filter in the loop, beside ours on the same record:

laglab run lab --estimator stonesoup_ekf:StoneSoupEkf --estimator delayed-ekf
"""

import numpy as np
from stonesoup.base import Property
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.models.transition.base import TransitionModel
from stonesoup.predictor.kalman import ExtendedKalmanPredictor
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.prediction import GaussianStatePrediction
from stonesoup.types.update import GaussianStateUpdate
from stonesoup.updater.kalman import ExtendedKalmanUpdater

from laglab_control import Backdated


class Robot(TransitionModel):
    """Our model as Stone Soup wants it; the predictor hands x and u through."""

    robot: object = Property()
    ndim_state = 3

    def function(self, state, x=None, u=None, **_):
        return np.vstack(self.robot.f(np.array(x), np.array(u)))

    def jacobian(self, state, x=None, u=None, **_):
        return self.robot.A(np.array(x), np.array(u))

    def covar(self, x=None, **_):
        W = self.robot.W(np.array(x))
        return W @ self.robot.Q @ W.T

    pdf = rvs = None  # it asks for them, and uses neither


class StoneSoupEkf(Backdated):
    """Stone Soup's EKF, run again from where a late measurement belongs."""

    optimal = True

    def __init__(self, model):
        super().__init__(model)
        self.predictor = ExtendedKalmanPredictor(Robot(model))
        self.updater = ExtendedKalmanUpdater(LinearGaussian(3, (0, 1, 2), model.R))

    def forward(self, x, P, u):
        prior = GaussianStateUpdate(np.vstack(x), P, None)
        return _parts(self.predictor.predict(prior, x=tuple(x), u=tuple(u)))

    def corrected(self, x, P, z):
        near = x + self.model.innovation(z, x)  # its headings are no angles: the one next to ours
        prediction = GaussianStatePrediction(np.vstack(x), P)
        return _parts(self.updater.update(SingleHypothesis(prediction, Detection(np.vstack(near)))))


def _parts(state):
    return np.array(state.mean, float).ravel(), np.array(state.covar, float)
