"""The linear case: no filter can do better than the batch least-squares solution."""

import numpy as np

from laglab_control import DelayedEkf, NonlinearModel, ReplayedInputs, constant_delay, replay

F, B = np.array([[1.0, 0.1], [0.0, 0.95]]), np.array([[0.005], [0.1]])
Q, R = np.array([[2e-3, 1e-3], [1e-3, 4e-3]]), np.array([[0.3]])
H = np.array([[1.0, 0.0]])

CART = NonlinearModel(
    f=lambda x, u: F @ x + B @ u,
    A=lambda _x, _u: F,
    W=lambda _x, _u: np.eye(2),
    Q=Q,
    h=lambda x: H @ x,
    H=lambda _: H,
    R=R,
)
"""A cart on a rail: x = [position, speed], u = [acceleration], z = [position]."""


def batch(x0, P0, inputs, measurements, used, k):
    """Weighted least squares over x_0 ... x_k at once; the part for x_k and its covariance."""
    size = 2 * (k + 1)
    information, vector = np.zeros((size, size)), np.zeros(size)

    def add(jacobian, value, covariance):
        nonlocal information, vector
        weight = np.linalg.inv(covariance)
        information = information + jacobian.T @ weight @ jacobian
        vector = vector + jacobian.T @ weight @ value

    def state(j):
        return np.eye(size)[2 * j : 2 * j + 2]

    add(state(0), x0, P0)
    for j in range(k):
        add(state(j + 1) - F @ state(j), B @ inputs[j], Q)
    for s in range(used):
        add(H @ state(s), measurements[s], R)
    covariance = np.linalg.inv(information)
    return (covariance @ vector)[-2:], covariance[-2:, -2:]


def test_delayed_ekf_is_the_batch_least_squares_solution():
    random, ticks, m = np.random.default_rng(2), 40, 6
    x0, P0 = np.array([1.0, -0.5]), np.diag([0.5, 0.2])
    inputs, measurements = random.normal(size=(ticks, 1)), random.normal(size=(ticks + 1, 1))
    answer = replay(
        DelayedEkf(CART, ReplayedInputs(CART)),
        x0,
        P0,
        inputs,
        constant_delay(measurements, m),
    )
    for k in range(0, ticks + 1, 5):
        x, P = batch(x0, P0, inputs, measurements, max(k - m + 1, 0), k)
        assert np.abs(answer.estimates[k] - x).max() < 1e-10
        assert np.abs(answer.covariances[k] - P).max() < 1e-10
