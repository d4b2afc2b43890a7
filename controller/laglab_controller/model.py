"""What every filter needs to know of a system: (5), linearised as in (25) and (26)."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from laglab_controller.angle import direction, wrap
from laglab_controller.errors import ConfigError

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]


class Model(Protocol):
    """x_{k+1} = f(x_k, u_k, w_k), z_k = h(x_k, v_k), and their Jacobians, in the paper's letters.

    Shapes: x (d,), u (p,), z (q,). Units are the model's own.
    """

    def f(self, x: Vector, u: Vector) -> Vector:
        """The next state (d,) without noise."""
        ...

    def A(self, x: Vector, u: Vector) -> Matrix:
        """df/dx (d, d) at (x, u, 0), as in (25)."""
        ...

    def process_noise(self, x: Vector, u: Vector) -> Matrix:
        """W Q W^T (d, d), the covariance of w~ in (25)."""
        ...

    def h(self, x: Vector) -> Vector:
        """The measurement (q,) without noise."""
        ...

    def H(self, x: Vector) -> Matrix:
        """dh/dx (q, d) at (x, 0), as in (26)."""
        ...

    def measurement_noise(self, x: Vector) -> Matrix:
        """V R V^T (q, q), the covariance of v~ in (26)."""
        ...

    def innovation(self, z: Vector, expected: Vector) -> Vector:
        """z - expected (q,), with every angle in it wrapped to (-pi, pi]."""
        ...


def constant(values: ArrayLike, shape: tuple[int, ...], name: str) -> NDArray[np.float64]:
    """A read-only double array of that shape. Raises ConfigError, naming it, for any other."""
    array = np.array(values, dtype=np.float64)
    if array.shape != shape:
        raise ConfigError(f"{name} must have shape {shape}, not {array.shape}")
    array.setflags(write=False)
    return array


IDENTITY = constant(np.eye(3), (3, 3), "I")


@dataclass(frozen=True, eq=False)
class RobotModel:
    """The differential-drive robot of section 2: x = [x, y, theta] [m, m, rad], u = [v, omega].

    `Q` (2, 2) is the covariance of the wheel speeds' noise [w_L, w_R] [(rad/s)^2], `R` (3, 3) that
    of the measurement [m^2, m^2, rad^2]. The defaults are the paper's (30). theta is not wrapped.
    """

    sample_time: float = 0.01
    wheel_radius: float = 0.05
    track: float = 0.6
    Q: Matrix = field(default_factory=lambda: np.diag([0.01, 0.01]))
    R: Matrix = field(default_factory=lambda: np.diag([0.01, 0.01, 0.018]))

    def __post_init__(self) -> None:
        object.__setattr__(self, "Q", constant(self.Q, (2, 2), "Q"))
        object.__setattr__(self, "R", constant(self.R, (3, 3), "R"))

    def f(self, x: Vector, u: Vector) -> Vector:
        """(3)."""
        x_, y, theta = x.tolist()
        v, omega = u.tolist()
        Ts, (cosine, sine) = self.sample_time, direction(theta)
        return np.array((x_ + Ts * v * cosine, y + Ts * v * sine, theta + Ts * omega))

    def A(self, x: Vector, u: Vector) -> Matrix:
        """(31)."""
        distance, (cosine, sine) = self.sample_time * float(u[0]), direction(float(x[2]))
        return np.array(
            ((1.0, 0.0, -distance * sine), (0.0, 1.0, distance * cosine), (0.0, 0.0, 1.0))
        )

    def W(self, x: Vector) -> Matrix:
        """(32) with the sign of the third row corrected; columns w_L, w_R."""
        cosine, sine = direction(float(x[2]))
        turn = 2 / self.track
        scale = self.sample_time * self.wheel_radius / 2
        return scale * np.array(((cosine, cosine), (sine, sine), (-turn, turn)))

    def process_noise(self, x: Vector, u: Vector) -> Matrix:
        """W Q W^T of (27)."""
        W = self.W(x)
        return W @ self.Q @ W.T

    def h(self, x: Vector) -> Vector:
        """The pose itself, whose Jacobian is (33)."""
        return x

    def H(self, x: Vector) -> Matrix:
        """(33)."""
        return IDENTITY

    def measurement_noise(self, x: Vector) -> Matrix:
        """R, for V = I in (33)."""
        return self.R

    def innovation(self, z: Vector, expected: Vector) -> Vector:
        """z - expected with the heading wrapped."""
        difference = z - expected
        difference[2] = wrap(float(difference[2]))
        return difference
