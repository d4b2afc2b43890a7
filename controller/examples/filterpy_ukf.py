"""filterpy's unscented Kalman filter in the loop, beside ours on the same record:

laglab run lab --estimator filterpy_ukf:Ukf --estimator delayed-ekf
"""

from filterpy.kalman import MerweScaledSigmaPoints, UnscentedKalmanFilter

from laglab_control import Backdated


class Ukf(Backdated):
    """filterpy's UKF, run again from where a late measurement belongs."""

    optimal = True

    def __init__(self, model, alpha=0.5, beta=2.0, kappa=0.0):
        super().__init__(model)
        self.points = MerweScaledSigmaPoints(3, alpha, beta, kappa)
        self.ukf = UnscentedKalmanFilter(
            3,
            3,
            model.sample_time,
            hx=model.h,
            fx=lambda x, _, u: model.f(x, u),
            points=self.points,
            residual_z=model.innovation,
        )
        self.ukf.R = model.R

    def forward(self, x, P, u):
        """Through the sigma points; its own state is set before each use, so nothing is kept."""
        W = self.model.W(x)
        self.ukf.x, self.ukf.P, self.ukf.Q = x, P, W @ self.model.Q @ W.T
        self.ukf.predict(u=u)
        return self.ukf.x, self.ukf.P

    def corrected(self, x, P, z):
        """The same."""
        self.ukf.x, self.ukf.P = x, P
        self.ukf.sigmas_f = self.points.sigma_points(x, P)
        self.ukf.update(z)
        return self.ukf.x, self.ukf.P
