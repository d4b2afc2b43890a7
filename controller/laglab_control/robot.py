"""The robot (1), (3) as a model for the filters; its Jacobians and noise (30) to (33)."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from laglab_control.angle import direction, wrap
from laglab_control.limits import Positive, check, covariance
from laglab_control.model import Matrix, Vector, identity
from laglab_control.motion import Motion, Way, moved


class Ways(Protocol):
    """Something that tells where a robot gets."""

    def way(self, u: Vector) -> Way[float]:
        """Where one tick with input u leads."""
        ...


@dataclass(frozen=True, eq=False)
class RobotModel:
    """The differential-drive robot: x = [x, y, theta] [m, m, rad], u = [v, omega] [m/s, rad/s].

    `sample_time` [s], `wheel_radius` [m], `track` [m]. `Q` (2, 2) is the covariance of the wheel
    speeds' noise [w_L, w_R] [(rad/s)^2], `R` (3, 3) that of the measurement [m^2, m^2, rad^2]. The
    defaults are the paper's, (30). theta is not wrapped. Raises ConfigError, naming the field, for
    a value that cannot be.
    """

    sample_time: Positive = 0.01
    wheel_radius: Positive = 0.05
    track: Positive = 0.6
    Q: Matrix = field(default_factory=lambda: np.diag([0.01, 0.01]))
    R: Matrix = field(default_factory=lambda: np.diag([0.01, 0.01, 0.018]))

    def __post_init__(self) -> None:
        check(self)
        object.__setattr__(self, "Q", covariance(self.Q, 2, "Q"))
        object.__setattr__(self, "R", covariance(self.R, 3, "R"))

    def f(self, x: Vector, u: Vector) -> Vector:
        """(3): the pose (3,) one tick later."""
        x_, y, theta = x.tolist()
        v, omega = u.tolist()
        Ts, (cosine, sine) = self.sample_time, direction(theta)
        return np.array((x_ + Ts * v * cosine, y + Ts * v * sine, theta + Ts * omega))

    def A(self, x: Vector, u: Vector) -> Matrix:
        """(31), (3, 3)."""
        distance, (cosine, sine) = self.sample_time * float(u[0]), direction(float(x[2]))
        dx, dy = distance * cosine, distance * sine
        return np.array((1.0, 0.0, -dy, 0.0, 1.0, dx, 0.0, 0.0, 1.0)).reshape(3, 3)

    def W(self, x: Vector) -> Matrix:
        """(32), (3, 2): columns w_L, w_R."""
        cosine, sine = direction(float(x[2]))
        turn = 2 / self.track
        scale = self.sample_time * self.wheel_radius / 2
        return scale * np.array(((cosine, cosine), (sine, sine), (-turn, turn)))

    def motion(self, u: Vector) -> Motion[float]:
        """One tick of (3): g_k = (Ts v, 0, Ts omega), with W Q W^T as seen from the robot."""
        v, omega = u.tolist()
        return Motion(self.sample_time * v, 0.0, self.sample_time * omega, *self.noise)

    def way(self, u: Vector) -> Way[float]:
        """Where one tick of (3) leads."""
        v, omega = u.tolist()
        return Way(self.sample_time * v, 0.0, self.sample_time * omega)

    def predict(self, x: Vector, P: Matrix, u: Vector) -> tuple[Vector, Matrix]:
        """(27), all in one: A P A^T + W Q W^T is how the covariance of a motion composes."""
        return moved(x, P, self.motion(u))

    def h(self, x: Vector) -> Vector:
        """The pose itself, whose Jacobian is (33)."""
        return x

    def H(self, x: Vector) -> Matrix:
        """(33), (3, 3)."""
        return identity(3)

    def measurement_noise(self, x: Vector) -> Matrix:
        """R, for V = I in (33)."""
        return self.R

    def innovation(self, z: Vector, expected: Vector) -> Vector:
        """z - expected with the heading wrapped."""
        difference = z - expected
        difference[2] = wrap(float(difference[2]))
        return difference

    @cached_property
    def noise(self) -> tuple[float, ...]:
        """The upper triangle of W Q W^T (32) at theta = 0: elsewhere it only turns."""
        W = self.W(np.zeros(3))
        return tuple((W @ self.Q @ W.T)[np.triu_indices(3)].tolist())
