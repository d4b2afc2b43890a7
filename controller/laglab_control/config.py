"""What a station is told before it begins."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from laglab_control.errors import ConfigError
from laglab_control.estimators.family import estimator_kind
from laglab_control.laws import Law, PolarLaw, SpeedLimits
from laglab_control.limits import Ticks, check, covariance, finite_pose
from laglab_control.robot import RobotModel

INITIAL_VARIANCE = 1e-4
"""P_0 = INITIAL_VARIANCE I by default [m^2, m^2, rad^2]."""
KINDS = {
    "estimator": str,
    "estimator_options": Mapping,
    "model": RobotModel,
    "limits": SpeedLimits,
    "guard": bool,
}
"""Of a StationConfig's fields that are no numbers."""
FAR = 1000.0
"""[m] No run leads a robot further from its goal: an estimate beyond this has gone astray."""


def is_far(pose: Iterable[float], goal: Iterable[float]) -> bool:
    """Whether a pose [m, m, rad] is not finite, or further than FAR from the goal."""
    x, y, theta = pose
    x_goal, y_goal, _ = goal
    return not (math.isfinite(theta) and math.hypot(x - x_goal, y - y_goal) <= FAR)


@dataclass(frozen=True, eq=False)
class StationConfig:
    """What the station is told. Poses [m, m, rad], delays in ticks.

    `estimator` is one of ESTIMATORS, an installed plug-in, or `module:Class`. Raises PluginError
    for one that cannot be had, and ConfigError, naming the field, for a value that cannot be.
    """

    estimator: str = "popf"
    estimator_options: Mapping[str, object] = field(default_factory=dict)
    """Of one that somebody brought, which is made as `Class(model, **options)`."""
    model: RobotModel = field(default_factory=RobotModel)
    law: Law = field(default_factory=PolarLaw)
    limits: SpeedLimits = field(default_factory=SpeedLimits)
    """Of the commands, whatever the law asks for."""
    goal: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """What the run is about: whoever is FAR from it is lost."""
    initial_estimate: ArrayLike = (0.0, 0.0, 0.0)
    initial_covariance: ArrayLike = field(default_factory=lambda: np.eye(3) * INITIAL_VARIANCE)
    command_delay: Ticks = 0
    """n, until the echoes tell: it is then estimated from the command that each measurement
    echoes. The delay m of a measurement is read from its own stamp."""
    plan: Ticks = 0
    """H: how many ticks are planned beyond each command."""
    guard: bool = False
    """Whether the estimator is watched (`Guard`)."""
    first_tick: Ticks = 0
    """The robot's tick that is the controller's tick 0: the law's time is the robot's."""

    def __post_init__(self) -> None:
        for name, kind in KINDS.items():
            if not isinstance(getattr(self, name), kind):
                raise ConfigError(f"{name} must be of {kind.__name__}, not {getattr(self, name)!r}")
        if not callable(getattr(self.law, "drive", None)):
            raise ConfigError(f"law must be one, with a method drive, not {self.law!r}")
        estimator_kind(self.estimator, self.estimator_options)
        check(self)
        x = finite_pose(self.initial_estimate, "initial_estimate")
        P = covariance(self.initial_covariance, 3, "initial_covariance")
        finite_pose(self.goal, "goal")
        if is_far(x.tolist(), self.goal):
            raise ConfigError(
                f"initial_estimate must be within {FAR:g} m of the goal, not {x.tolist()}"
            )
        object.__setattr__(self, "initial_estimate", x)
        object.__setattr__(self, "initial_covariance", P)


def without_blind_guard(config: StationConfig) -> StationConfig:
    """The same, unguarded if the estimator does not show how wild a measurement is."""
    estimator = estimator_kind(config.estimator, config.estimator_options).make(config.model)
    return config if estimator.is_watchable else replace(config, guard=False)
