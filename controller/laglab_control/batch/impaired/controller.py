"""Estimate, extrapolate, command, for many robots on impaired links."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch.impaired.doubt import Doubts
from laglab_control.batch.impaired.estimators import DelayedEkf, Ekf, Estimator, Raw
from laglab_control.batch.impaired.guard import Suspicion
from laglab_control.batch.impaired.paper import Popf
from laglab_control.batch.impaired.record import Record
from laglab_control.batch.impaired.sent import Sent
from laglab_control.batch.impaired.timetable import Timetable, Tokens
from laglab_control.batch.law import drive, limited, polar_law, stand_still
from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.robots import Estimate, Robots, diverged, prior_of
from laglab_control.batch.rows import Belief, Pose, Speeds, headings
from laglab_control.config import StationConfig
from laglab_control.errors import ConfigError
from laglab_control.estimators.family import estimator_kind
from laglab_control.model import Matrix
from laglab_control.motion import joined_along

IMPAIRED: Mapping[str, Callable[[Robots, Record, Belief], Estimator]] = {
    "raw": Raw,
    "ekf": Ekf,
    "popf": Popf,
    "popf-printed": partial(Popf, innovation_at_k=True),
    "delayed-ekf": DelayedEkf,
}
"""Those that there are for many robots on impaired links, by name."""


class Answers(NamedTuple):
    """Of all robots at a tick."""

    pose: Pose
    """The estimates after the tick's correction; NaN where there is none."""
    P: Symmetric | None
    """What is claimed for their errors; None: nothing."""
    speeds: Speeds
    """The commands."""
    lost: NDArray[np.bool_]
    """The robots whose estimate has diverged."""


class ImpairedController:
    """As many controllers as there are initial estimates (3, robots) [m, m, rad], all else alike.

    `timetable` says what reaches whom when. `answer` once a tick, from tick 0 on.
    Raises ConfigError when there is no such estimator or law for many robots, or R is not diagonal.
    """

    def __init__(
        self, config: StationConfig, initial_estimates: Matrix, timetable: Timetable
    ) -> None:
        if config.estimator not in IMPAIRED:
            raise ConfigError(
                f"there is no {config.estimator} for many robots, but {', '.join(IMPAIRED)}"
            )
        robots, count = Robots(config.model), timetable.robots
        self._config, self._law, self._timetable = config, polar_law(config), timetable
        self._began = np.array(initial_estimates)
        self._predicts = estimator_kind(config.estimator).predicts
        self._sent = Sent(robots, count, timetable.ticks, timetable.reach)
        self._record = Record(timetable, self._sent)
        prior = prior_of(config, self._began)
        self._estimator = IMPAIRED[config.estimator](robots, self._record, prior)
        self._suspicion = Suspicion(count) if config.guard else None
        self._doubts = Doubts(timetable, self._sent, config.model.sample_time)
        self._lost = np.zeros(count, np.bool_)
        self._last = stand_still(count)
        self._tick = -1

    @property
    def acts(self) -> NDArray[np.bool_]:
        """The robots whose guard would have acted by now."""
        return np.zeros_like(self._lost) if self._suspicion is None else self._suspicion.acts

    def answer(self, z: Pose) -> Answers:
        """The next tick, at which z is sampled; it arrives when it does."""
        self._tick = tick = self._tick + 1
        self._record.sample(tick, z)
        if tick:
            self._record.believe(tick)
        weighed = self._estimator.go_on(tick, self._record.put_right(tick))
        if self._suspicion is not None:
            self._suspicion.look(weighed)
        pose, P = self._estimator.estimate(tick)
        if P is not None:
            P = P if self._suspicion is None else self._suspicion.claimed(P)
            P = self._doubts.added(P, pose, tick)
        there = ~np.isnan(pose.theta) if P is None else np.True_
        self._lost = self._lost | there & diverged(pose, self._config.goal, self._began)
        self._command(Estimate(pose, P), there & ~self._lost)
        self._sent.push(tick, self._last.speeds)
        return Answers(pose, P, self._last.speeds, self._lost)

    def applied(self) -> Speeds:
        """What is in force from this tick to the next."""
        commands, shares = self._timetable.applied
        return self._sent.inputs(Tokens(commands[self._tick], shares[self._tick]))

    def _command(self, estimate: Estimate, driven: NDArray[np.bool_]) -> None:
        (pose, P), config, tick = estimate, self._config, self._tick
        if self._predicts:
            ahead = self._sent.way(tick - self._timetable.delay[tick], np.full(len(driven), tick))
            pose = joined_along(headings(pose.theta), pose, ahead)
        speeds, at_goal = drive(self._law, pose, self._last.at_goal)
        last, sample_time = self._last.speeds, config.model.sample_time
        speeds = limited(config.limits, speeds, P, last, sample_time)
        if not driven.all():
            speeds = Speeds(*[np.where(driven, each, 0.0) for each in speeds])
            at_goal = at_goal & driven
        self._last = self._last._replace(speeds=speeds, at_goal=at_goal)
