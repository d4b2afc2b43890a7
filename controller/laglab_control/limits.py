"""What values may be: said in the types of a dataclass's fields, checked when one is made."""

import math
from collections.abc import Mapping
from functools import cache
from numbers import Integral, Real
from types import NoneType
from typing import Annotated, NamedTuple, get_args, get_type_hints

import numpy as np
from numpy.typing import ArrayLike

from laglab_control.errors import ConfigError
from laglab_control.model import Matrix, Vector, constant

ROUNDING = 1e-9
"""The share of its largest element by which a covariance may be asymmetric, or not semidefinite."""


class Limit(NamedTuple):
    """What a finite number must be: `least` or more, or `above` it, and at most `most`; `whole`:
    without a fraction."""

    least: float
    above: bool = False
    most: float = math.inf
    whole: bool = False
    optional: bool = False
    """Whether None will do."""

    def __str__(self) -> str:
        number = "a whole number" if self.whole else "a finite number"
        limited = f"above {self.least:g}" if self.above else f"of {self.least:g} or more"
        bounded = f", and at most {self.most:g}" if self.most < math.inf else ""
        return f"{number} {limited}{bounded}" + (", or None" if self.optional else "")

    def allows(self, value: object) -> bool:
        """Whether `value` is such a number; True and False are none."""
        if value is None:
            return self.optional
        if not isinstance(value, Integral if self.whole else Real) or isinstance(value, bool):
            return False
        try:
            number = float(value)
        except OverflowError:
            return False
        enough = number > self.least if self.above else number >= self.least
        return enough and number <= self.most and math.isfinite(number)


Positive = Annotated[float, Limit(0, above=True)]
Ticks = Annotated[int, Limit(0, whole=True)]


@cache
def limits(of: type) -> Mapping[str, Limit]:
    """The limits of a dataclass's fields, by name."""
    hints = get_type_hints(of, include_extras=True)
    found = {name: _limit(hint) for name, hint in hints.items()}
    return {name: limit for name, limit in found.items() if limit is not None}


def _limit(hint: object) -> Limit | None:
    parts = get_args(hint)
    for part in (hint, *parts):
        for said in getattr(part, "__metadata__", ()):
            if isinstance(said, Limit):
                return said._replace(optional=NoneType in parts)
    return None


def check(made: object) -> None:
    """Raises ConfigError, naming the field, for a value beyond its limits."""
    of: type = type(made)
    for name, limit in limits(of).items():
        value = getattr(made, name)
        if not limit.allows(value):
            raise ConfigError(f"{name} must be {limit}, not {value!r}")


def finite_pose(values: ArrayLike, name: str) -> Vector:
    """Read-only (3,) [m, m, rad]. Raises ConfigError, naming it, for what is no finite pose."""
    return _finite(values, (3,), name)


def covariance(values: ArrayLike, size: int, name: str) -> Matrix:
    """Read-only (size, size). Raises ConfigError, naming it, for what is no covariance."""
    P = _finite(values, (size, size), name)
    tolerance = ROUNDING * float(np.abs(P).max())
    if np.abs(P - P.T).max() > tolerance:
        raise ConfigError(f"{name} must be symmetric, not {P.tolist()}")
    if np.linalg.eigvalsh(P)[0] < -tolerance:
        raise ConfigError(f"{name} must be positive semidefinite, not {P.tolist()}")
    return P


def _finite(values: ArrayLike, shape: tuple[int, ...], name: str) -> Matrix:
    array = constant(values, shape, name)
    if not np.isfinite(array).all():
        raise ConfigError(f"{name} must be finite, not {array.tolist()}")
    return array
