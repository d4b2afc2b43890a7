"""How large an error is by the covariance that was claimed for it: e^T P^-1 e."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NOTHING = 1e-12
"""A share of a variance: if less is left once the other components are known, that is rounding."""


def nees(error: Array, P: Array) -> Array:
    """Of errors (..., 3) and covariances (..., 3, 3), shape (...).

    NaN where P is not positive definite, or anything is not finite.
    """
    return nees_by_triangle(error, P[..., [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]])


def nees_by_triangle(error: Array, triangle: Array) -> Array:
    """The same, given of each P the upper triangle (..., 6). By P = L D L^T, L with ones on its
    diagonal."""
    xx, xy, xt, yy, yt, tt = np.moveaxis(triangle, -1, 0)
    with np.errstate(all="ignore"):
        # P = L D L^T
        l10, l20 = xy / xx, xt / xx
        d1 = yy - l10 * xy
        l21 = (yt - l20 * xy) / d1
        d2 = tt - l20 * xt - l21 * l21 * d1
        # L y = e
        y0 = error[..., 0]
        y1 = error[..., 1] - l10 * y0
        y2 = error[..., 2] - l20 * y0 - l21 * y1
        value = y0 * y0 / xx + y1 * y1 / d1 + y2 * y2 / d2
        definite = (xx > 0) & (d1 > NOTHING * yy) & (d2 > NOTHING * tt)
        definite &= np.isfinite(value)
    return np.where(definite, value, np.nan)
