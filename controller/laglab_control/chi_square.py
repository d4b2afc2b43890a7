"""The chi-square distribution with a whole number of degrees of freedom."""

import math
from functools import cache


def chi_square_tail(x: float, degrees: int) -> float:
    """P(X > x): a finite sum for whole degrees (Abramowitz and Stegun 26.4.4 and 26.4.5)."""
    if x <= 0:
        return 1.0
    half, odd = x / 2, degrees % 2
    tail = math.erfc(math.sqrt(half)) if odd else 0.0
    powers = (j + odd / 2 for j in range(degrees // 2))
    return tail + sum(math.exp(p * math.log(half) - half - math.lgamma(p + 1)) for p in powers)


@cache
def chi_square_bound(tail: float, degrees: int) -> float:
    """What X exceeds with probability `tail`, 0 < tail < 1: by bisection, to 1e-12 of it."""
    low, high = 0.0, float(degrees)
    while chi_square_tail(high, degrees) > tail:
        low, high = high, 2 * high
    while high - low > 1e-12 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if chi_square_tail(middle, degrees) > tail else (low, middle)
    return high
