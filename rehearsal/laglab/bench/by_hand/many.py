"""Many robots as one would write them in numpy for the occasion: no FMU, no link, nothing general.

delayed-ekf in the loop: an EKF m ticks ago, replayed over the inputs since, extrapolated over those
in flight, and the law. Arrays over robots, matrices as numpy has them.
"""

from collections import deque
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control import RobotModel, StationConfig
from laglab_control.batch import polar_law

Array = NDArray[np.float64]


class Situation(NamedTuple):
    """What is the same for all robots; n, m and the length in ticks."""

    config: StationConfig
    n: int
    m: int
    ticks: int


def many_by_hand(starts: Array, P_0: float, situation: Situation) -> Array:
    """The poses (robots, 3) at the end."""
    config, n, m, ticks = situation
    model = config.model
    rng = np.random.default_rng(1)
    x, there = starts.copy(), starts.copy()
    P = np.tile(P_0 * np.eye(3), (len(x), 1, 1))
    stand = np.zeros((len(x), 2))
    measured = deque[Array]()
    inputs = deque([stand] * n)  # those between tick s and the end of what is in flight
    at_goal = np.zeros(len(x), bool)
    for k in range(ticks):
        measured.append(x + rng.normal(size=x.shape) * np.sqrt(np.diag(model.R)))
        if k > m:
            there, P = _predicted(model, there, P, inputs.popleft())
        if k >= m:
            there, P = _corrected(model, there, P, measured.popleft())
        ahead = there
        for u in inputs:
            ahead = _moved(model, ahead, u)
        u, at_goal = _law(config, ahead, at_goal)
        inputs.append(u)
        x = _moved(model, x, _slipping(model, inputs[-1 - n], rng))
    return x


def _moved(model: RobotModel, x: Array, u: Array) -> Array:
    theta, way = x[:, 2], model.sample_time * u[:, 0]
    turn = model.sample_time * u[:, 1]
    moved: Array = x + np.stack((way * np.cos(theta), way * np.sin(theta), turn), axis=1)
    return moved


def _slipping(model: RobotModel, u: Array, rng: np.random.Generator) -> Array:
    left, right = model.wheel_radius * rng.normal(size=(2, len(u))) * np.sqrt(model.Q[0, 0])
    slipping: Array = u + np.stack(((left + right) / 2, (right - left) / model.track), axis=1)
    return slipping


def _predicted(model: RobotModel, x: Array, P: Array, u: Array) -> tuple[Array, Array]:
    cosine, sine = np.cos(x[:, 2]), np.sin(x[:, 2])
    A = np.tile(np.eye(3), (len(x), 1, 1))
    A[:, 0, 2] = -model.sample_time * u[:, 0] * sine
    A[:, 1, 2] = model.sample_time * u[:, 0] * cosine
    turn = np.full(len(x), 2 / model.track)
    W = np.array(((cosine, cosine), (sine, sine), (-turn, turn))).transpose(2, 0, 1)
    W *= model.sample_time * model.wheel_radius / 2
    return _moved(model, x, u), A @ P @ A.swapaxes(1, 2) + W @ model.Q @ W.swapaxes(1, 2)


def _corrected(model: RobotModel, x: Array, P: Array, z: Array) -> tuple[Array, Array]:
    K = P @ np.linalg.inv(P + model.R)
    innovation = z - x
    innovation[:, 2] = _wrapped(innovation[:, 2])
    return x + np.einsum("rij,rj->ri", K, innovation), P - K @ P


def _law(
    config: StationConfig, x: Array, at_goal: NDArray[np.bool_]
) -> tuple[Array, NDArray[np.bool_]]:
    law, limits = polar_law(config), config.limits
    dx, dy = law.goal[0] - x[:, 0], law.goal[1] - x[:, 1]
    rho, psi = np.hypot(dx, dy), np.arctan2(dy, dx)
    alpha, phi = _wrapped(psi - x[:, 2]), _wrapped(psi - law.goal[2])
    near = law.goal_tolerance or 0.0
    at_goal = np.where(at_goal, rho <= 2 * near, rho < near)
    forward = law.gamma * np.cos(alpha)
    v = np.where(at_goal, 0.0, forward * rho)
    turn = law.lambda_ * alpha + forward * np.sinc(alpha / np.pi) * (alpha + law.h * phi)
    turn = np.where(at_goal, law.lambda_ / 2 * _wrapped(law.goal[2] - x[:, 2]), turn)
    v_max, omega_max = limits.v_max or np.inf, limits.omega_max or np.inf
    return np.stack((v.clip(-v_max, v_max), turn.clip(-omega_max, omega_max)), axis=1), at_goal


def _wrapped(angle: Array) -> Array:
    return np.arctan2(np.sin(angle), np.cos(angle))
