"""The correction of the extended Kalman filter, and the gain that every filter here shares.

Products are written A.dot(B): at this size twice as fast as A @ B.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from laglab_control.model import Matrix, Model, Vector, identity, symmetric
from laglab_control.motion import F

ILL_CONDITIONED = 1e-12
"""Below this ratio of the determinant to the product of the diagonal, S counts as singular."""

NO_DEVIATION = 1e-30
"""A standard deviation up to this, in whatever unit, is none: what is left of it is rounding."""


class Belief(NamedTuple):
    """An estimate x (d,) and the covariance P (d, d) that is claimed for its error."""

    x: Vector
    P: Matrix


class Innovation(NamedTuple):
    """z - h(x^-) (q,) and its claimed covariance S = H P^- H^T + R (q, q)."""

    value: Vector
    S: Matrix


class Corrected(NamedTuple):
    """What a measurement has made of a belief."""

    posterior: Belief
    innovation: Innovation


Triangle = tuple[float, float, float, float, float, float]
"""Of a symmetric matrix (3, 3): xx, xy, xt, yy, yt, tt."""


def normalised_squared(innovation: Innovation) -> float:
    """The NIS, v^T S^-1 v."""
    v, S = innovation
    if len(S) != 3:
        return float(v.dot(_inverse(S)).dot(v))
    components: list[float] = v.tolist()
    return weighted(components, precision(S))


def precision(S: Matrix) -> Triangle:
    """S^-1 of S (3, 3), in plain floats."""
    found = _cofactors(S)
    if found is None:
        (xx, xy, xt), (_, yy, yt), (_, _, tt) = _pseudo_inverse(S).tolist()
        return xx, xy, xt, yy, yt, tt
    (xx, xy, xt, yy, yt, tt), determinant = found
    scale = 1 / determinant
    return xx * scale, xy * scale, xt * scale, yy * scale, yt * scale, tt * scale


def _cofactors(S: Matrix) -> tuple[Triangle, float] | None:
    """Those of S (3, 3), and its determinant; None where S counts as singular."""
    (xx, xy, xt), (_, yy, yt), (_, _, tt) = S.tolist()
    c_xx, c_xy, c_xt = yy * tt - yt * yt, xt * yt - xy * tt, xy * yt - xt * yy
    determinant = xx * c_xx + xy * c_xy + xt * c_xt
    if not determinant > ILL_CONDITIONED * xx * yy * tt or min(xx, yy, tt) <= NO_DEVIATION**2:
        return None
    c_yy, c_yt, c_tt = xx * tt - xt * xt, xy * xt - xx * yt, xx * yy - xy * xy
    return (c_xx, c_xy, c_xt, c_yy, c_yt, c_tt), determinant


def weighted(v: Sequence[F], weights: Sequence[F]) -> F:
    """v^T W v, of one robot or of many; W by its upper triangle."""
    x, y, t = v
    xx, xy, xt, yy, yt, tt = weights
    return x * (xx * x + 2 * (xy * y + xt * t)) + y * (yy * y + 2 * yt * t) + tt * t * t


def correct(model: Model, prior: Belief, z: Vector) -> Corrected:
    """(8), with P+ in Joseph's form, which stays positive definite under rounding."""
    x, P = prior
    H, R = model.H(x), model.measurement_noise(x)
    PHt, HPHt = measured(P, H)
    S = HPHt + R
    K = gain(PHt, S)
    B = identity(len(x)) - times(K, H)
    v = model.innovation(z, model.h(x))
    P = _sound(symmetric(B.dot(P).dot(B.T) + K.dot(R).dot(K.T)), H)
    return Corrected(Belief(x + K.dot(v), P), Innovation(v, S))


def measured(P: Matrix, H: Matrix) -> tuple[Matrix, Matrix]:
    """P H^T and H P H^T."""
    if _is_all(H):
        return P, P
    PHt = P.dot(H.T)
    return PHt, H.dot(PHt)


def times(A: Matrix, H: Matrix) -> Matrix:
    """A H."""
    return A if _is_all(H) else A.dot(H)


def _is_all(H: Matrix) -> bool:
    """Whether the whole state is measured, as a pose is (33): then nothing need be multiplied."""
    return H is identity(len(H))


def _sound(P: Matrix, H: Matrix) -> Matrix:
    """P, or where rounding has cost it its definiteness the nearest covariance.

    Joseph's form keeps P positive definite while R is; with a perfect sensor some of P is nothing
    but rounding errors after a while. What is left of x once H x is known does not change, so it
    is enough to look at H x.
    """
    measured = P if len(H) == len(P) else H.dot(P).dot(H.T)
    if _is_definite(measured) or not np.all(np.isfinite(P)):
        return P
    values, vectors = np.linalg.eigh(P)
    return symmetric((vectors * np.maximum(values, 0)) @ vectors.T)


def _is_definite(P: Matrix) -> bool:
    """By the leading minors in plain floats for the robot's size: ten times as fast."""
    if len(P) != 3:
        return bool(np.linalg.eigvalsh(P)[0] > 0)
    (xx, xy, xt), (_, yy, yt), (_, _, tt) = P.tolist()
    minor = xx * yy - xy * xy
    determinant = tt * minor - xx * yt * yt - yy * xt * xt + 2 * xy * yt * xt
    return bool(xx > 0 and minor > 0 and determinant > 0)


def gain(cross: Matrix, S: Matrix) -> Matrix:
    """K = cross S^-1 (d, q), for S (q, q) symmetric; pseudo-inverted where it is singular."""
    K: Matrix = cross.dot(_inverse_of_three(S) if len(S) == 3 else _inverse(S))
    return K


def _inverse_of_three(S: Matrix) -> Matrix:
    """By cofactors, in plain floats: the robot's case, four times as fast as the general one."""
    found = _cofactors(S)
    if found is None:
        return _pseudo_inverse(S)
    (xx, xy, xt, yy, yt, tt), determinant = found
    inverse: Matrix = np.array((xx, xy, xt, xy, yy, yt, xt, yt, tt)) / determinant
    return inverse.reshape(3, 3)


def _inverse(S: Matrix) -> Matrix:
    try:
        return np.asarray(np.linalg.inv(S), dtype=np.float64)
    except np.linalg.LinAlgError:
        return _pseudo_inverse(S)


def _pseudo_inverse(S: Matrix) -> Matrix:
    """Of S scaled to a diagonal of ones, so that units do not decide what counts as zero."""
    if not np.all(np.isfinite(S)):
        return np.full_like(S, np.nan)
    diagonal = np.sqrt(np.abs(np.diag(S)))
    scale = np.where(diagonal > NO_DEVIATION, diagonal, np.inf)  # what is certain has no inverse
    units = np.outer(scale, scale)
    return np.asarray(
        np.linalg.pinv(S / units, ILL_CONDITIONED, hermitian=True) / units, dtype=np.float64
    )
