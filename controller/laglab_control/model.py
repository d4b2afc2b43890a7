"""What a filter needs to know of a system: (5), linearised as in (25) and (26)."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from laglab_control.angle import wrap
from laglab_control.errors import ConfigError

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


class Model(Protocol):
    """x_{k+1} = f(x_k, u_k, w_k), z_k = h(x_k, v_k), in the paper's letters.

    Shapes: x (d,), u (p,), z (q,). Units are the model's own.
    """

    def predict(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """(27): the prior x (d,), P (d, d) one tick later, with u in force meanwhile."""
        ...

    def A(self, x: Vector, u: Vector) -> Matrix:
        """df/dx (d, d) at (x, u, 0), as in (25)."""
        ...

    def h(self, x: Vector) -> Vector:
        """The measurement (q,) without noise."""
        ...

    def H(self, x: Vector) -> Matrix:
        """dh/dx (q, d) at (x, 0), as in (26)."""
        ...

    def measurement_noise(self, x: Vector) -> Matrix:
        """V R V^T (q, q), the covariance of V v in (26)."""
        ...

    def innovation(self, z: Vector, expected: Vector) -> Vector:
        """z - expected (q,), with every angle in it wrapped to (-pi, pi]."""
        ...


@dataclass(frozen=True, eq=False)
class NonlinearModel:
    """Any system, given by its functions and their Jacobians: the generic form of (25) to (28).

    `f(x, u)` (d,), `A(x, u)` (d, d) and `W(x, u)` (d, r) for the process noise w of covariance `Q`
    (r, r); `h(x)` (q,), `H(x)` (q, d) and the measurement noise of covariance `R` (q, q), which
    comes in through `V(x)` (q, q), the identity when left out. `angles` lists the components of z
    that are angles [rad].
    """

    f: Callable[[Vector, Vector], Vector]
    A: Callable[[Vector, Vector], Matrix]
    W: Callable[[Vector, Vector], Matrix]
    Q: Matrix
    h: Callable[[Vector], Vector]
    H: Callable[[Vector], Matrix]
    R: Matrix
    V: Callable[[Vector], Matrix] | None = None
    angles: tuple[int, ...] = ()

    def predict(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """(27), with A and W of tick k-1, as (25) defines them."""
        A, W = self.A(x, u), self.W(x, u)
        return self.f(x, u), symmetric(A @ P @ A.T + W @ self.Q @ W.T)

    def measurement_noise(self, x: Vector) -> Matrix:
        """V R V^T of (28)."""
        if self.V is None:
            return self.R
        V = self.V(x)
        return V @ self.R @ V.T

    def innovation(self, z: Vector, expected: Vector) -> Vector:
        """z - expected (q,), with `angles` wrapped."""
        difference = z - expected
        for i in self.angles:
            difference[i] = wrap(float(difference[i]))
        return difference


def symmetric(P: Matrix) -> Matrix:
    """(P + P^T)/2: rounding leaves a covariance a little lopsided."""
    return (P + P.T.copy()) * 0.5  # copied, for two arrays of one order are added twice as fast


def constant(values: ArrayLike, shape: tuple[int, ...], name: str) -> NDArray[np.float64]:
    """A read-only double array of that shape. Raises ConfigError, naming it, for any other."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ConfigError(f"{name} must be numbers of shape {shape}, not {values!r}") from None
    if array.shape != shape:
        raise ConfigError(f"{name} must have shape {shape}, not {array.shape}")
    array.setflags(write=False)
    return array


@cache
def identity(size: int) -> Matrix:
    """I, read-only."""
    return constant(np.eye(size), (size, size), "I")
