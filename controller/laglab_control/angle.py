"""Angles on the circle."""

import math

import numpy as np
from numpy.typing import NDArray


def wrap(angle: float) -> float:
    """The same angle in (-pi, pi], exact for any finite angle [rad]; NaN when it is not finite."""
    if not math.isfinite(angle):
        return math.nan
    remainder = math.remainder(angle, math.tau)
    return remainder if remainder > -math.pi else math.pi


def wrapped(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """`wrap` of many, of any shape, to rounding; small ones stay what they are, to the bit."""
    with np.errstate(invalid="ignore"):
        remainders: NDArray[np.float64] = angles - math.tau * np.rint(angles * (0.5 / math.pi))
    wrong = remainders <= -math.pi
    return np.where(wrong, math.pi, remainders) if wrong.any() else remainders


def direction(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle [rad]; NaN when it is not finite."""
    try:
        return math.cos(angle), math.sin(angle)
    except ValueError:
        return math.nan, math.nan
