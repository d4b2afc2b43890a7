"""Angles on the circle."""

import math


def wrap(angle: float) -> float:
    """The same angle in (-pi, pi], exact for any finite angle [rad]; NaN when it is not finite."""
    if not math.isfinite(angle):
        return math.nan
    remainder = math.remainder(angle, math.tau)
    return remainder if remainder > -math.pi else math.pi


def direction(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle [rad]; NaN when it is not finite."""
    try:
        return math.cos(angle), math.sin(angle)
    except ValueError:
        return math.nan, math.nan
