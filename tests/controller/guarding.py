"""Robots that drive, what is measured of them, and estimators that are watched meanwhile."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from laglab_control import ESTIMATORS, Alarm, Guard, Measured, RobotModel
from laglab_control.guard import Watched
from laglab_control.model import Vector

MODEL = RobotModel()
P_0 = np.eye(3) * 1e-4
U = np.array((0.5, 0.3))
M = 5
"""Ticks by which measurements are late."""


def guarded(name: str = "delayed-ekf") -> Guard:
    return Guard(ESTIMATORS[name].make(MODEL), MODEL)


def driven(
    ticks: int, inputs: Iterable[Vector] = (), start: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> list[Vector]:
    """The poses of a robot that starts there and drives a circle, or as the inputs say."""
    poses = [np.array(start)]
    for _, u in zip(range(ticks), list(inputs) or [U] * ticks, strict=False):
        poses.append(MODEL.f(poses[-1], u))
    return poses


def sampled(poses: Sequence[Vector], seed: int) -> list[Measured]:
    noise = np.random.default_rng(seed).multivariate_normal(np.zeros(3), MODEL.R, len(poses))
    return [Measured(k, pose + v) for k, (pose, v) in enumerate(zip(poses, noise, strict=True))]


def followed(
    estimator: Any, measured: Sequence[Measured], x: Vector | None = None
) -> list[Watched]:
    """The states at every tick, each measurement M ticks late."""
    state = estimator.start(np.zeros(3) if x is None else x, P_0)
    states = []
    for k in range(len(measured) + M):
        if k:
            state = estimator.predict(state, U)
        state = estimator.correct(state, measured[k - M : k - M + 1] if k >= M else [])
        states.append(state)
    return states


def alarms(states: Sequence[Watched]) -> list[Alarm]:
    return [state.alarm for state in states if state.alarm]
