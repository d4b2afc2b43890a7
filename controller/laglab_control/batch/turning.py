"""Rigid motions of many robots that know the cosine and sine of where they turn to.

Half of a batch's time would go into them: so those of a product are taken from those of its factors
where the last bit does not matter. Without noise it does: a robot then comes so near to its goal
that the last bit decides where it looks, and the runs one by one are to be met.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from laglab_control.batch.rows import Belief, Heading, Pose, Row, headings
from laglab_control.motion import Motion, Way, composed_along, joined_along


class Turned(NamedTuple):
    """A motion, or a belief, which is one from the origin; and its heading."""

    motion: Belief
    heading: Heading


class TurnedWay(NamedTuple):
    """The same of a way, or of a pose."""

    way: Pose
    heading: Heading


@dataclass(frozen=True)
class Turning:
    """`exact`: as `laglab_control.motion` has it, to the last bit."""

    exact: bool

    def composed(self, first: Turned, second: Turned) -> Turned:
        """Two windows in a row; of a belief and a window (27), over one tick or over many."""
        motion = composed_along(first.heading, first.motion, second.motion)
        return Turned(motion, self._added(motion.theta, first.heading, second.heading))

    def joined(self, first: TurnedWay, second: TurnedWay) -> TurnedWay:
        """Two ways in a row."""
        way = joined_along(first.heading, first.way, second.way)
        return TurnedWay(way, self._added(way.theta, first.heading, second.heading))

    def _added(self, angle: Row, first: Heading, second: Heading) -> Heading:
        """Of the sum of two angles."""
        if self.exact:
            return headings(angle)
        (c, s), (cosine, sine) = first, second
        return c * cosine - s * sine, s * cosine + c * sine


def turned(belief: Belief) -> Turned:
    """With the heading that its angle has."""
    return Turned(belief, headings(belief.theta))


def way_of(turned: Turned) -> TurnedWay:
    """Without the covariance."""
    motion, heading = turned
    return TurnedWay(Way(motion.x, motion.y, motion.theta), heading)


def nowhere() -> Turned:
    """No motion at all, for any number of robots."""
    return turned(Motion(*[np.zeros(1)] * 9))
