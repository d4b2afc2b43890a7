"""What happens when, on links that lose, delay at random and reorder; nothing of values.

Which command is in force when, which measurements come when, and what the station then knows of
the past, depends on the link alone. So it can be known before anything drives.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Whole = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Tokens(NamedTuple):
    """Inputs: the shares of the commands made at some ticks. A share 0 is standing still."""

    commands: Whole
    shares: NDArray[np.float64]


class News(NamedTuple):
    """Inputs that turn out to have been others than was believed until now."""

    tick: Whole
    """At which the station learns it."""
    j: Whole
    """Of the input."""
    inputs: Tokens


class Arrivals(NamedTuple):
    """Measurements that come for the first time; those of a tick in the order of sampling."""

    tick: Whole
    s: Whole
    newer: Flags
    """Sampled later than all that came before."""
    settled: Flags
    """The inputs that led there are known."""


class Missing(NamedTuple):
    """Inputs j <= `known` of which nothing is known at a tick."""

    tick: Whole
    j: Whole


class Course(NamedTuple):
    """Of one robot, ticks 0 ... N."""

    applied: Tokens
    """(N+1,)"""
    delay: Whole
    """(N+1,), n as the station has it after what came at the tick."""
    usual: Whole
    """(N+1,), `Told.usual`; -1 before the first echo."""
    known: Whole
    """(N+1,), `Told.known`."""
    spread: NDArray[np.float64]
    """(N+1,), `Told.spread`."""
    in_force: Tokens
    """(N+1,), `Told.in_force`."""
    before: Tokens
    """(N+1,), `Told.before`."""
    news: News
    arrivals: Arrivals
    missing: Missing

    @property
    def reach(self) -> int:
        """How many ticks back anything refers at most."""
        back = [np.arange(len(self.known)) - self.known, self.news.tick - self.news.j]
        back += [self.arrivals.tick - self.arrivals.s, self.missing.tick - self.missing.j]
        return int(self.delay.max()) + max(int(each.max(initial=0)) for each in back)


class NewsNow(NamedTuple):
    """Of one tick."""

    robots: Whole
    j: Whole
    inputs: Tokens


class ArrivalsNow(NamedTuple):
    """Of one tick, at most one of each robot."""

    robots: Whole
    s: Whole
    newer: Flags
    settled: Flags

    def chosen(self, these: Flags) -> "ArrivalsNow":
        """Only these."""
        robots, s, newer, settled = self
        return ArrivalsNow(robots[these], s[these], newer[these], settled[these])


class MissingNow(NamedTuple):
    """Of one tick."""

    robots: Whole
    j: Whole


class Timetable:
    """The courses of many robots, tick by tick."""

    def __init__(self, courses: Sequence[Course], measurement_delay: int) -> None:
        self.robots = len(courses)
        self.ticks = len(courses[0].delay)
        self.applied = _stacked([each.applied for each in courses])
        self.in_force = _stacked([each.in_force for each in courses])
        self.before = _stacked([each.before for each in courses])
        self.delay = np.stack([each.delay for each in courses], axis=1)
        self.usual = np.stack([each.usual for each in courses], axis=1)
        self.known = np.stack([each.known for each in courses], axis=1)
        self.spread = np.stack([each.spread for each in courses], axis=1)
        self.news = self._news([each.news for each in courses])
        self.arrivals = self._arrivals([each.arrivals for each in courses])
        self.missing = self._missing([each.missing for each in courses])
        self.reach = max(each.reach for each in courses)
        """How many ticks back anything refers at most."""
        self.least_delay = measurement_delay
        """No measurement takes fewer ticks."""

    def arrivals_of(self, tick: int, robots: Whole) -> list[ArrivalsNow]:
        """The `arrivals` of these robots at a tick."""
        arrivals = self.arrivals[tick]
        if len(robots) == self.robots:
            return arrivals
        chosen = np.zeros(self.robots, np.bool_)
        chosen[robots] = True
        of_these = []
        for each in arrivals:
            kept = chosen[each.robots]
            if kept.any():
                of_these.append(each.chosen(kept))
        return of_these

    def _order(self, ticks: Sequence[Whole]) -> tuple[Whole, Whole, Whole]:
        """The robots, and the order by ticks, of what is known robot by robot; and the bounds of
        each tick in it."""
        robots = np.repeat(np.arange(self.robots), [len(each) for each in ticks])
        tick = np.concatenate(ticks)
        order = np.argsort(tick, kind="stable")
        return robots[order], order, np.searchsorted(tick[order], np.arange(self.ticks + 1))

    def _news(self, news: Sequence[News]) -> list[NewsNow]:
        robots, order, at = self._order([each.tick for each in news])
        j = np.concatenate([each.j for each in news])[order]
        commands = np.concatenate([each.inputs.commands for each in news])[order]
        shares = np.concatenate([each.inputs.shares for each in news])[order]
        return [
            NewsNow(robots[a:b], j[a:b], Tokens(commands[a:b], shares[a:b]))
            for a, b in zip(at[:-1].tolist(), at[1:].tolist(), strict=True)
        ]

    def _missing(self, missing: Sequence[Missing]) -> list[MissingNow]:
        robots, order, at = self._order([each.tick for each in missing])
        j = np.concatenate([each.j for each in missing])[order]
        return [
            MissingNow(robots[a:b], j[a:b])
            for a, b in zip(at[:-1].tolist(), at[1:].tolist(), strict=True)
        ]

    def _arrivals(self, arrivals: Sequence[Arrivals]) -> list[list[ArrivalsNow]]:
        """By tick: the first of each robot, the second of those that have two, and so on."""
        robots, order, at = self._order([each.tick for each in arrivals])
        s = np.concatenate([each.s for each in arrivals])[order]
        newer = np.concatenate([each.newer for each in arrivals])[order]
        settled = np.concatenate([each.settled for each in arrivals])[order]
        by_tick = []
        for a, b in zip(at[:-1].tolist(), at[1:].tolist(), strict=True):
            now = ArrivalsNow(robots[a:b], s[a:b], newer[a:b], settled[a:b])
            turn = _turns(now.robots)
            by_tick.append([now.chosen(turn == i) for i in range(int(turn.max(initial=-1)) + 1)])
        return by_tick


def _turns(robots: Whole) -> Whole:
    """How many of the same robot stand before each, in a sorted row."""
    return np.arange(len(robots)) - np.searchsorted(robots, robots)


def _stacked(tokens: Sequence[Tokens]) -> Tokens:
    return Tokens(
        np.stack([each.commands for each in tokens], axis=1),
        np.stack([each.shares for each in tokens], axis=1),
    )
