"""How large an error is by the covariance that was claimed for it: e^T P^-1 e."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NOTHING = 1e-12
"""Of a variance: what is left below this when the other components are known is rounding."""


def nees(error: Array, P: Array) -> Array:
    """Of errors (..., 3) and covariances (..., 3, 3), shape (...).

    NaN where P is not positive definite, or anything is not finite. By P = L D L^T, L with ones on
    its diagonal; only the lower triangle of P is read.
    """
    with np.errstate(all="ignore"):
        # P = L D L^T
        d0 = P[..., 0, 0]
        l10, l20 = P[..., 1, 0] / d0, P[..., 2, 0] / d0
        d1 = P[..., 1, 1] - l10 * P[..., 1, 0]
        l21 = (P[..., 2, 1] - l20 * P[..., 1, 0]) / d1
        d2 = P[..., 2, 2] - l20 * P[..., 2, 0] - l21 * l21 * d1
        # L y = e
        y0 = error[..., 0]
        y1 = error[..., 1] - l10 * y0
        y2 = error[..., 2] - l20 * y0 - l21 * y1
        value = y0 * y0 / d0 + y1 * y1 / d1 + y2 * y2 / d2
        definite = (d0 > 0) & (d1 > NOTHING * P[..., 1, 1]) & (d2 > NOTHING * P[..., 2, 2])
        definite &= np.isfinite(value)
    return np.where(definite, value, np.nan)
