"""The two phases of the extended Kalman filter: (7) and (8), in the form (25), (26) gives them."""

from typing import NamedTuple

import numpy as np

from laglab_controller.model import Matrix, Model, Vector


class Belief(NamedTuple):
    """An estimate x (d,) and the covariance P (d, d) that is claimed for its error."""

    x: Vector
    P: Matrix


def symmetric(P: Matrix) -> Matrix:
    """(P + P^T)/2: rounding leaves a covariance a little lopsided."""
    return (P + P.T) / 2


def predict(model: Model, belief: Belief, u: Vector) -> tuple[Belief, Matrix]:
    """(27) with A and W of tick k-1, as (25) defines them; also gives that A."""
    x, P = belief
    A = model.A(x, u)
    return Belief(model.f(x, u), symmetric(A @ P @ A.T + model.process_noise(x, u))), A


def gain(cross: Matrix, S: Matrix) -> Matrix:
    """cross S^{-1}, for S symmetric; with the pseudo-inverse where S is singular."""
    try:
        solution = np.linalg.solve(S, cross.T)
    except np.linalg.LinAlgError:
        solution = np.linalg.pinv(S, hermitian=True) @ cross.T
    return np.asarray(solution.T, dtype=np.float64)


def correct(model: Model, prior: Belief, z: Vector) -> Belief:
    """(8), with P+ in Joseph's form, which stays positive definite under rounding."""
    x, P = prior
    H, R = model.H(x), model.measurement_noise(x)
    K = gain(P @ H.T, H @ P @ H.T + R)
    B = np.eye(len(x)) - K @ H
    posterior = x + K @ model.innovation(z, model.h(x))
    return Belief(posterior, symmetric(B @ P @ B.T + K @ R @ K.T))
