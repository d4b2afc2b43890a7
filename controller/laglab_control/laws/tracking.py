"""The tracking law of Kanayama, Kimura, Miyazaki and Noguchi (1990)."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from laglab_control.angle import direction, wrap
from laglab_control.laws.interface import Demand
from laglab_control.laws.paths import Path
from laglab_control.limits import Positive, check


@dataclass(frozen=True)
class TrackingLaw:
    """Follows `path`. Gains: `k_x` [1/s], `k_y` [1/m^2], `k_theta` [1/m].

    Raises ConfigError, naming the field, for a value that cannot be.
    """

    path: Path
    k_x: Positive = 2.0
    k_y: Positive = 16.0
    k_theta: Positive = 8.0

    def __post_init__(self) -> None:
        check(self)

    def drive(self, pose: Iterable[float], time: float, memory: object) -> Demand:
        """The command at a finite `pose` (3,) [m, m, rad], for where the path is at `time` [s]; it
        remembers nothing."""
        x, y, theta = pose
        reference = self.path.at(time)
        cosine, sine = direction(theta)
        dx, dy = reference.x - x, reference.y - y
        ahead, aside = cosine * dx + sine * dy, cosine * dy - sine * dx
        turn = wrap(reference.theta - theta)
        correction = self.k_y * aside + self.k_theta * math.sin(turn)
        return Demand(
            reference.v * math.cos(turn) + self.k_x * ahead,
            reference.omega + reference.v * correction,
        )
