"""What the stations of many robots do not know of the inputs (`laglab_control.doubt`)."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from laglab_control.batch.impaired.sent import Sent
from laglab_control.batch.impaired.timetable import Flags, Timetable, Tokens, Whole
from laglab_control.batch.matrices import Symmetric, plus_square
from laglab_control.batch.rows import Pose, Row, Speeds, headings
from laglab_control.doubt import PATIENCE, STOPS_AFTER, Missed
from laglab_control.motion import Way


@dataclass(frozen=True, eq=False)
class Doubts:
    """Of all robots, tick by tick."""

    timetable: Timetable
    sent: Sent
    sample_time: float

    @cached_property
    def _everybody(self) -> Whole:
        return np.arange(self.timetable.robots)

    @cached_property
    def _believed(self) -> Whole:
        """(ticks, robots): how many inputs nothing was told of yet."""
        return np.arange(self.timetable.ticks)[:, None] - 1 - self.timetable.known

    @cached_property
    def _interrupted(self) -> Flags:
        usual = self.timetable.usual
        return (usual >= 0) & (self._believed > usual + PATIENCE)

    @cached_property
    def _scattered(self) -> Flags:
        """Where commands come into force at odd times."""
        told = (self.timetable.usual >= 0) & ~self._interrupted
        return told & (self.timetable.spread > 0) & (self._believed > 0)

    def added(self, P: Symmetric, pose: Pose, tick: int) -> Symmetric:
        """P, and d d^T for each doubt."""
        cosine, sine = headings(pose.theta)
        for distance, turn, length in self._missed(tick):
            aside = length / 2 * turn
            x, y = distance * cosine - aside * sine, distance * sine + aside * cosine
            P = plus_square(P, Way(x, y, turn))
        return P

    def _missed(self, tick: int) -> Iterator["Missed[Row]"]:
        interrupted, scattered = self._interrupted[tick], self._scattered[tick]
        if interrupted.any():
            yield _where(interrupted, self._held(tick))
            yield _where(interrupted, self._stopped(tick))
        if scattered.any():
            yield _where(scattered, self._shifted(tick))
        if len(self.timetable.missing[tick].j):
            yield self._untold(tick)

    def _sum(self, tick: int, since: Whole) -> Speeds:
        """Of the inputs believed from tick `since` on."""
        delay = self.timetable.delay[tick]
        return self.sent.sums(np.minimum(since, tick) - delay, tick - delay)

    def _held(self, tick: int) -> "Missed[Row]":
        Ts, believed = self.sample_time, self._believed[tick]
        v_sum, omega_sum = self._sum(tick, self.timetable.known[tick] + 1)
        v, omega = self.sent.inputs(_at(self.timetable.in_force, tick))
        return Missed(
            Ts * (v_sum - believed * v), Ts * (omega_sum - believed * omega), Ts * abs(v_sum)
        )

    def _stopped(self, tick: int) -> "Missed[Row]":
        Ts = self.sample_time
        since = self.timetable.known[tick] + 1 + round(STOPS_AFTER / Ts)
        v_sum, omega_sum = self._sum(tick, since)
        return Missed(Ts * v_sum, Ts * omega_sum, Ts * abs(v_sum))

    def _shifted(self, tick: int) -> "Missed[Row]":
        Ts, believed = self.sample_time, self._believed[tick]
        v, omega = self.sent.inputs(_at(self.timetable.in_force, tick))
        made = tick - 1 - self.timetable.delay[tick]
        v_now, omega_now = self.sent.commands(made, self._everybody)
        late = Ts * self.timetable.spread[tick]
        return Missed(late * (v_now - v), late * (omega_now - omega), Ts * believed * abs(v_now))

    def _untold(self, tick: int) -> "Missed[Row]":
        Ts, count = self.sample_time, self.timetable.robots
        robots, j = self.timetable.missing[tick]
        v, omega = self.sent.inputs(_at(self.timetable.before, tick))
        believed = self.sent.commands(j - self.timetable.delay[tick][robots], robots)
        missing = np.bincount(robots, minlength=count)
        distance, turn = np.zeros(count), np.zeros(count)
        np.add.at(distance, robots, believed.v - v[robots])
        np.add.at(turn, robots, believed.omega - omega[robots])
        return Missed(Ts * distance, Ts * turn, Ts * missing * abs(v))


def _at(tokens: Tokens, tick: int) -> Tokens:
    return Tokens(tokens.commands[tick], tokens.shares[tick])


def _where(there: Flags, missed: "Missed[Row]") -> "Missed[Row]":
    if there.all():
        return missed
    return Missed(*[np.where(there, each, 0.0) for each in missed])
