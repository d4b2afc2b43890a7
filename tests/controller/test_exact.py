"""popf-exact claims the covariance that its error has: an independent computation agrees."""

import numpy as np
import pytest

from laglab_control import Measured, NonlinearModel, PopfExact

F = np.array([[1.0, 0.1], [-0.2, 0.9]])
Q = np.array([[2e-2, 1e-2], [1e-2, 4e-2]])
R = np.array([[0.05]])
H = np.array([[1.0, 0.3]])
MODEL = NonlinearModel(
    f=lambda x, _u: F @ x,
    A=lambda _x, _u: F,
    W=lambda _x, _u: np.eye(2),
    Q=Q,
    h=lambda x: H @ x,
    H=lambda _: H,
    R=R,
)
P0 = np.diag([0.5, 0.2])


def gains_and_claims(m, ticks):
    """K_k and P_k+ of every tick; a measurement of 1 more than expected shows K."""
    estimator, gains, claims = PopfExact(MODEL), [], []
    state = estimator.start(np.zeros(2), P0)
    priors = []
    for k in range(ticks):
        state = estimator.predict(state, np.zeros(1)) if k else state
        priors.append(state.x)
        z = [Measured(k - m, H @ priors[k - m] + 1)] if k >= m else []
        before, state = state.x, estimator.correct(state, z)
        gains.append((state.x - before)[:, np.newaxis])
        claims.append(state.P)
    return gains, claims


def true_covariances(gains, m):
    """Of x~_k+, from the noises up: x~ is linear in x~_0, all w_j and all v_s, which are white."""
    ticks = len(gains)
    sources = [P0] + [Q] * ticks + [R] * ticks
    starts = np.cumsum([0, *(len(source) for source in sources)])
    covariance = np.zeros((starts[-1], starts[-1]))
    for a, b, source in zip(starts, starts[1:], sources, strict=False):
        covariance[a:b, a:b] = source
    basis = np.eye(starts[-1])
    w = [basis[starts[1 + j] : starts[2 + j]] for j in range(ticks)]
    v = [basis[starts[1 + ticks + s] : starts[2 + ticks + s]] for s in range(ticks)]
    error, priors, answer = basis[:2], [], []
    for k, K in enumerate(gains):
        priors.append(error)
        if k >= m:
            error = error - K @ (H @ priors[k - m] - v[k - m])
        answer.append(error @ covariance @ error.T)
        error = F @ error - w[k]
    return answer


@pytest.mark.parametrize("m", [0, 1, 5])
def test_the_claimed_covariance_is_the_true_one(m):
    gains, claims = gains_and_claims(m, ticks=30)
    assert np.abs(np.array(claims) - true_covariances(gains, m)).max() < 1e-12


@pytest.mark.parametrize("m", [1, 5])
def test_no_other_gain_of_the_last_tick_does_better(m):
    gains, claims = gains_and_claims(m, ticks=20)
    best = np.trace(claims[-1])
    for change in 0.01 * np.array([[[1], [0]], [[-1], [0]], [[0], [1]], [[0], [-1]]]):
        other = true_covariances([*gains[:-1], gains[-1] + change], m)
        assert np.trace(other[-1]) > best
