"""The commands sent, one after the other as if each had been in force for a tick."""

import numpy as np
from numpy.typing import NDArray

from laglab_control.batch.impaired.past import Past, Rows
from laglab_control.batch.impaired.timetable import Tokens, Whole
from laglab_control.batch.robots import Robots, composed
from laglab_control.batch.rows import Belief, Pose, Row, Speeds, headings
from laglab_control.motion import Motion, Way
from laglab_control.past import MEMORY

MOTION = 9
"""Rows of one."""


class Sent:
    """Of many robots: what each stretch of their commands leads to, at a cost that does not depend
    on its length.

    What was not heard of yet is believed to come into force n ticks late; so an estimate is carried
    to the present over such a stretch, and on to where a command comes into force over another.
    Before tick 0 the robots stand still.
    """

    def __init__(self, robots: Robots, count: int, ticks: int, reach: int) -> None:
        """`reach`: how many ticks back a stretch begins at most."""
        self._robots, self._everybody = robots, np.arange(count)
        self._speeds = Past(ticks, 2, count)
        self._led = Past(reach + 2, MOTION + 2, count)
        standing = robots.motion(Speeds(np.zeros(count), np.zeros(count)))
        for tick in range(-reach, 1):
            # counted from -MEMORY, so that rounding is the same whoever is in this batch
            covariance = [(tick + MEMORY) * each for each in standing[3:]]
            self._led.keep(tick, [*np.zeros((3, count)), *covariance, *np.zeros((2, count))])

    def push(self, tick: int, u: Speeds) -> None:
        """The commands of this tick."""
        self._speeds.keep(tick, u)
        *led, v, omega = self._led.at(tick)
        further = composed(Motion(*led), self._robots.motion(u))
        self._led.keep(tick + 1, [*further, v + u.v, omega + u.omega])

    def inputs(self, tokens: Tokens) -> Speeds:
        """Of all robots."""
        return self.inputs_of(tokens, self._everybody)

    def inputs_of(self, tokens: Tokens, robots: Whole) -> Speeds:
        """Of these."""
        v, omega = self._speeds.of(tokens.commands, robots)
        return Speeds(tokens.shares * v, tokens.shares * omega)

    def commands(self, ticks: Whole, robots: Whole) -> Speeds:
        """Made at these ticks; before tick 0: standing still."""
        return self.inputs_of(Tokens(np.maximum(ticks, 0), (ticks >= 0).astype(np.float64)), robots)

    def sums(self, first: Whole, last: Whole) -> Speeds:
        """Of the commands made at the ticks from `first` to before `last`."""
        before, then = self._at(first), self._at(last)
        return Speeds(then[MOTION] - before[MOTION], then[MOTION + 1] - before[MOTION + 1])

    def way(self, first: Whole, last: Whole) -> Pose:
        """Where those lead."""
        before, then = self._at(first), self._at(last)
        return _way(headings(before[2]), before, then)

    def motion(self, first: Whole, last: Whole) -> Belief:
        """Where, and how surely."""
        before, then = self._at(first), self._at(last)
        c, s = headings(before[2])
        return Motion(*_way((c, s), before, then), *_covariance((c, s), before, then))

    def _at(self, ticks: Whole) -> Rows:
        return self._led.of(ticks, self._everybody)


def _way(heading: tuple[Row, Row], before: Rows, then: Rows) -> Pose:
    """g of x_then = x_before . g."""
    c, s = heading
    dx, dy = then[0] - before[0], then[1] - before[1]
    return Way(c * dx + s * dy, c * dy - s * dx, then[2] - before[2])


def _covariance(heading: tuple[Row, Row], before: Rows, then: Rows) -> list[NDArray[np.float64]]:
    """P_g of P_then = J P_before J^T + T P_g T^T (`compose`)."""
    c, s = heading
    a_xx, a_xy, a_xt, a_yy, a_yt, a_tt = before[3:MOTION]
    xx, xy, xt, yy, yt, tt = then[3:MOTION]
    dx, dy = then[0] - before[0], then[1] - before[1]
    xx = xx - (a_xx - 2 * dy * a_xt + dy * dy * a_tt)
    xy = xy - (a_xy + dx * a_xt - dy * a_yt - dx * dy * a_tt)
    xt = xt - (a_xt - dy * a_tt)
    yy = yy - (a_yy + 2 * dx * a_yt + dx * dx * a_tt)
    yt = yt - (a_yt + dx * a_tt)
    cc, cs, ss = c * c, c * s, s * s
    return [
        cc * xx + 2 * cs * xy + ss * yy,
        (cc - ss) * xy + cs * (yy - xx),
        c * xt + s * yt,
        ss * xx - 2 * cs * xy + cc * yy,
        c * yt - s * xt,
        tt - a_tt,
    ]
