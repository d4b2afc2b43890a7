"""The estimators for many robots whose measurements come when they do.

Each does what the one of its name does in `laglab_control.estimators`.
"""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from laglab_control.batch.impaired.past import Past
from laglab_control.batch.impaired.record import Record
from laglab_control.batch.impaired.sent import MOTION
from laglab_control.batch.impaired.timetable import ArrivalsNow, Whole
from laglab_control.batch.matrices import Symmetric
from laglab_control.batch.predicted import predicted
from laglab_control.batch.robots import (
    Compared,
    Estimate,
    Robots,
    composed,
    estimate_of,
)
from laglab_control.batch.rows import Belief, headings
from laglab_control.motion import Motion, Way


class Weighed(NamedTuple):
    """Measurements that arrive, and what each was compared with."""

    arrivals: ArrivalsNow
    compared: Compared


class Estimator(Protocol):
    """Goes from tick to tick."""

    def go_on(self, tick: int, since: Whole) -> Sequence[Weighed]:
        """To this tick, with all that arrived there, and right again where the inputs that led to
        ticks from `since` (robots,) on were others than believed. Gives what was compared."""
        ...

    def estimate(self, tick: int) -> Estimate:
        """Of this tick, the last that it went on to; NaN where there is none."""
        ...


class Raw(Estimator):
    """`raw`: the newest measurement."""

    def __init__(self, robots: Robots, record: Record, prior: Belief) -> None:
        self._record = record
        self._pose = np.full((3, record.timetable.robots), np.nan)

    def go_on(self, tick: int, since: Whole) -> Sequence[Weighed]:
        """No input matters."""
        for arrivals in self._record.timetable.arrivals[tick]:
            newer = arrivals.chosen(arrivals.newer)
            self._pose[:, newer.robots] = self._record.measured(newer)
        return []

    def estimate(self, tick: int) -> Estimate:
        """NaN where nothing has come yet."""
        return Estimate(Way(*self._pose), None)


class Ekf(Estimator):
    """`ekf`: takes z_s for z_k."""

    def __init__(self, robots: Robots, record: Record, prior: Belief) -> None:
        timetable = record.timetable
        self._robots, self._record, self._prior = robots, record, prior
        self._beliefs = Past(timetable.reach + 2, MOTION, timetable.robots)

    def go_on(self, tick: int, since: Whole) -> Sequence[Weighed]:
        """Each from its first input that was wrong."""
        for again in range(int(since.min(initial=tick)), tick):
            self._go_through(again, np.flatnonzero(since <= again))
        return self._go_through(tick, self._record.everybody)

    def _go_through(self, tick: int, robots: Whole) -> list[Weighed]:
        belief = self._prior
        if tick:
            before = Motion(*self._beliefs.of(tick - 1, robots))
            u = self._record.inputs_of(tick - 1, robots)
            belief = predicted(self._robots.model, before, headings(before.theta), u)
        self._beliefs.keep_of(tick, robots, belief)
        weighed = []
        for arrivals in self._record.timetable.arrivals_of(tick, robots):
            newer = arrivals.chosen(arrivals.newer)
            weighed.append(Weighed(newer, self._correct(tick, newer)))
        return weighed

    def _correct(self, tick: int, arrivals: ArrivalsNow) -> Compared:
        before, z = self._beliefs.of(tick, arrivals.robots), self._record.measured(arrivals)
        posterior, compared = self._robots.correct(Motion(*before), Way(*z))
        self._beliefs.keep_of(tick, arrivals.robots, posterior)
        return compared

    def estimate(self, tick: int) -> Estimate:
        """After its corrections."""
        return estimate_of(Motion(*self._beliefs.at(tick).copy()))


class DelayedEkf(Estimator):
    """`delayed-ekf`: the EKF at the newest measurement's tick, and what was sent since.

    All robots go through the same ticks, which costs no more than going through them with a few:
    those that had nothing to put right come to the same numbers again, and what is beyond the
    newest measurement of one will be gone through again when there is a newer one.
    """

    def __init__(self, robots: Robots, record: Record, prior: Belief) -> None:
        timetable = record.timetable
        depth = timetable.reach + 2
        self._robots, self._record, self._prior = robots, record, prior
        self._beliefs = Past(depth, MOTION, timetable.robots)
        self._arrived = np.zeros((timetable.ticks, timetable.robots), np.bool_)
        self._newest = np.zeros(timetable.robots, np.int64)
        self._beliefs.keep(0, prior)

    def go_on(self, tick: int, since: Whole) -> Sequence[Weighed]:
        """From the oldest news to the newest measurement."""
        first, news = np.minimum(since, self._newest + 1), self._record.timetable.arrivals[tick]
        for robots, s, *_ in news:
            self._arrived[s, robots] = True
            first[robots] = np.minimum(first[robots], s)
            self._newest[robots] = np.maximum(self._newest[robots], s)
        begin = int(first.min(initial=tick + 1, where=first <= self._newest))
        compared = {
            again: self._go_through(again) for again in range(begin, int(self._newest.max()) + 1)
        }
        return [self._weighed(arrivals, compared) for arrivals in news]

    def _go_through(self, tick: int) -> Compared:
        prior = self._prior
        if tick:
            before = Motion(*self._beliefs.at(tick - 1))
            u = self._record.inputs(tick - 1)
            prior = predicted(self._robots.model, before, headings(before.theta), u)
        posterior, compared = self._robots.correct(prior, self._record.z(tick))
        there = self._arrived[tick]
        if not there.all():
            posterior = Motion(
                *[np.where(there, *pair) for pair in zip(posterior, prior, strict=True)]
            )
        self._beliefs.keep(tick, posterior)
        return compared

    def _weighed(self, arrivals: ArrivalsNow, compared: dict[int, Compared]) -> Weighed:
        v, weights = np.empty((3, len(arrivals.s))), np.empty((6, len(arrivals.s)))
        for s in np.unique(arrivals.s).tolist():
            here = arrivals.s == s
            of = arrivals.robots[here]
            for row, of_all in zip((*v, *weights), (*compared[s][0], *compared[s][1]), strict=True):
                row[here] = of_all[of]
        return Weighed(arrivals, Compared(Way(*v), Symmetric(*weights)))

    def estimate(self, tick: int) -> Estimate:
        """Carried on over what is believed of the inputs since."""
        delay, everybody = self._record.timetable.delay[tick], self._record.everybody
        there = self._beliefs.of(self._newest, everybody)
        window = self._record.sent.motion(self._newest - delay, tick - delay)
        return estimate_of(composed(Motion(*there), window))
