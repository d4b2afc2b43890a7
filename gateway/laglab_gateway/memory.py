"""The speeds that were in force at the last ticks, for a station that missed what told of them."""

import math
from collections import OrderedDict
from collections.abc import Iterable, Iterator
from itertools import islice

from laglab_protocol import RECALLED, Applied, Recall, Speeds

__all__ = [
    "Owed",
    "SpeedMemory",
]

KEPT = 1024
"""Ticks; a station that heard nothing for longer meets the robot anew."""

APPLIED_A_TICK = 5
"""So many LAGLAB_APPLIED at most go with a tick, so that its datagram stays in one piece."""
MOST_OWED = KEPT // RECALLED + 1

UNKNOWN = (math.nan, math.nan)


class SpeedMemory:
    """By tick, as they come; the oldest are forgotten."""

    def __init__(self) -> None:
        self._speeds = OrderedDict[int, Speeds]()

    def keep(self, tick: int, speeds: Speeds) -> None:
        """In force on [t_tick, t_{tick+1})."""
        self._speeds[tick] = speeds
        if len(self._speeds) > KEPT:
            self._speeds.popitem(last=False)

    def learn(self, told: Applied) -> None:
        """Keep what a robot with a memory of its own tells."""
        known = zip(told.v, told.omega, range(told.first, told.first + told.count), strict=False)
        for v, omega, tick in known:
            if math.isfinite(v) and math.isfinite(omega):
                self.keep(tick, (v, omega))

    def answers(self, asked: Recall) -> Iterator[Applied]:
        """The ticks asked for, as far as they are known; a stretch where none is, is left out."""
        end = asked.first + min(asked.count, KEPT)
        for first in range(asked.first, end, RECALLED):
            count = min(RECALLED, end - first)
            speeds = [self._speeds.get(first + i, UNKNOWN) for i in range(count)]
            if any(each is not UNKNOWN for each in speeds):
                v, omega = zip(*speeds, *[(0.0, 0.0)] * (RECALLED - count), strict=True)
                yield Applied(v, omega, first, count)

    def lacks(self, asked: Recall) -> bool:
        """Whether some tick that is asked for is not known."""
        ticks = range(asked.first, asked.first + min(asked.count, KEPT))
        return any(tick not in self._speeds for tick in ticks)

    def forget(self) -> None:
        """The ticks begin again."""
        self._speeds.clear()


class Owed:
    """What the station asked to be told, and will be in the next ticks' datagrams."""

    def __init__(self) -> None:
        self._answers: dict[int, Applied] = {}
        """By first tick, in the order in which they will be told."""

    def owe(self, answers: Iterable[Applied]) -> None:
        """Some more answers; one that already waits is not told twice."""
        for answer in answers:
            if len(self._answers) < MOST_OWED:
                self._answers.setdefault(answer.first, answer)

    def take(self) -> list[Applied]:
        """What goes with this tick."""
        if not self._answers:
            return []
        return [self._answers.pop(first) for first in list(islice(self._answers, APPLIED_A_TICK))]

    def forget(self) -> None:
        """Nobody waits for it any more."""
        self._answers.clear()
