"""What the stations of many robots have heard and believe, tick by tick."""

import numpy as np

from laglab_control.batch.impaired.past import Past, Rows
from laglab_control.batch.impaired.sent import Sent
from laglab_control.batch.impaired.timetable import ArrivalsNow, Timetable, Whole
from laglab_control.batch.rows import Pose, Speeds
from laglab_control.motion import Way


class Record:
    """All that the estimators are told."""

    def __init__(self, timetable: Timetable, sent: Sent) -> None:
        self.timetable = timetable
        self.sent = sent
        self.everybody = np.arange(timetable.robots)
        self._sampled = Past(timetable.ticks, 3, timetable.robots)
        self._inputs = Past(timetable.reach + 2, 2, timetable.robots)

    def sample(self, tick: int, z: Pose) -> None:
        """z_k, which will arrive when it does."""
        self._sampled.keep(tick, z)

    def believe(self, tick: int) -> None:
        """That on [t_{k-1}, t_k) the command made n ticks before was in force."""
        made = tick - 1 - self.timetable.delay[tick - 1]
        self._inputs.keep(tick - 1, self.sent.commands(made, self.everybody))

    def put_right(self, tick: int) -> Whole:
        """Correct what was believed wrongly. Gives for each robot (robots,) the first tick that a
        wrong input led to; the next tick where there was none."""
        robots, j, tokens = self.timetable.news[tick]
        since = np.full(self.timetable.robots, tick + 1)
        if len(j):
            right = np.stack(self.sent.inputs_of(tokens, robots))
            wrong = (self._inputs.of(j, robots) != right).any(axis=0)
            self._inputs.put(j, robots, right)
            np.minimum.at(since, robots[wrong], j[wrong] + 1)
        return since

    def inputs(self, tick: int) -> Speeds:
        """In force on [t_k, t_{k+1}), as known by now."""
        return Speeds(*self._inputs.at(tick))

    def inputs_of(self, tick: int, robots: Whole) -> Speeds:
        """Of these robots."""
        return Speeds(*self._inputs.of(tick, robots))

    def measured(self, arrivals: ArrivalsNow) -> Rows:
        """The poses that have arrived (3, n)."""
        return self._sampled.of(arrivals.s, arrivals.robots)

    def z(self, tick: int) -> Pose:
        """z_k of all robots, arrived or not."""
        return Way(*self._sampled.at(tick))
