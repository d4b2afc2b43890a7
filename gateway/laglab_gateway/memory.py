"""The speeds that were in force at the last ticks, for a station that missed what told of them."""

import math
from collections.abc import Iterator

from laglab_protocol import RECALLED, Applied, Recall

KEPT = 1024
"""Ticks; a station that heard nothing for longer meets the robot anew."""

UNKNOWN = (math.nan, math.nan)
Speeds = tuple[float, float]
"""v [m/s], omega [rad/s]."""


class SpeedMemory:
    """By tick, as they come; the oldest are forgotten."""

    def __init__(self) -> None:
        self._speeds: dict[int, Speeds] = {}

    def keep(self, tick: int, speeds: Speeds) -> None:
        """In force on [t_tick, t_{tick+1})."""
        self._speeds[tick] = speeds
        if len(self._speeds) > KEPT:
            del self._speeds[next(iter(self._speeds))]

    def learn(self, told: Applied) -> None:
        """What a robot of its own memory says."""
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
