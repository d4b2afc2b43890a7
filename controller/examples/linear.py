"""A cart on a rail whose position arrives 8 ticks late: four filters, and the textbook's.

The textbook Kalman filter gets every measurement at once, so none of the others can do better than
it; given the measurements without delay, delayed-ekf is the textbook's filter.
"""

import numpy as np

from laglab_control import (
    DelayedEkf,
    Ekf,
    NonlinearModel,
    Popf,
    PopfExact,
    ReplayedInputs,
    constant_delay,
    replay,
)

TICKS, M = 400, 8
Ts = 0.05
F, B = np.array([[1.0, Ts], [0.0, 1.0]]), np.array([[Ts**2 / 2], [Ts]])
H, Q, R = np.array([[1.0, 0.0]]), np.array([[0.02]]), np.array([[0.09]])
X_0, P_0 = np.zeros(2), np.diag([0.01, 0.01])

CART = NonlinearModel(
    f=lambda x, u: F @ x + B @ u,
    A=lambda _x, _u: F,
    W=lambda _x, _u: B,
    Q=Q,
    h=lambda x: H @ x,
    H=lambda _x: H,
    R=R,
)
"""x = [position [m], speed [m/s]], u = [acceleration [m/s^2]], z = [position [m]]."""


def drive(random):
    """True states (N+1, 2), inputs (N, 1) and measurements (N+1, 1)."""
    inputs = np.sin(np.arange(TICKS) * Ts)[:, np.newaxis]
    states = [X_0 + np.sqrt(P_0) @ random.normal(size=2)]
    for u in inputs:
        states.append(F @ states[-1] + B @ (u + np.sqrt(Q[0]) * random.normal(size=1)))
    states = np.array(states)
    return states, inputs, states[:, :1] + np.sqrt(R[0]) * random.normal(size=(TICKS + 1, 1))


def textbook(inputs, measurements):
    """The Kalman filter (7), (8) without any delay; estimates (N+1, 2)."""
    x, P, estimates = X_0, P_0, []
    for k, z in enumerate(measurements):
        if k > 0:
            x, P = F @ x + B @ inputs[k - 1], F @ P @ F.T + B @ Q @ B.T
        K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
        x, P = x + K @ (z - H @ x), (np.eye(2) - K @ H) @ P
        estimates.append(x)
    return np.array(estimates)


def main():
    """RMS error in position of each, printed; and how delayed-ekf and the textbook compare."""
    states, inputs, measurements = drive(np.random.default_rng(1))
    filters = {
        "ekf": Ekf(CART),
        "popf": Popf(CART),
        "popf-exact": PopfExact(CART),
        "delayed-ekf": DelayedEkf(CART, ReplayedInputs(CART)),
    }
    arrivals = constant_delay(measurements, M)
    errors = {"textbook, no delay": textbook(inputs, measurements) - states}
    for name, estimator in filters.items():
        errors[name] = replay(estimator, X_0, P_0, inputs, arrivals).estimates - states
    for name, error in errors.items():
        print(f"{name:18}  {np.sqrt(np.mean(error[M:, 0] ** 2)):8.4f} m")
    undelayed = replay(filters["delayed-ekf"], X_0, P_0, inputs, constant_delay(measurements, 0))
    difference = np.abs(undelayed.estimates - textbook(inputs, measurements)).max()
    print(f"without delay, delayed-ekf and the textbook differ by {difference:.1e}")


if __name__ == "__main__":
    main()
