"""Two wheels that do not lead as far as believed."""

from collections.abc import Sequence
from dataclasses import dataclass

from laglab_control.estimators.calibrating.parameters import Taken
from laglab_control.model import Vector


@dataclass(frozen=True)
class WheelScales:
    """b = [b_L, b_R]: the left wheel leads 1 + b_L times as far as believed, the right 1 + b_R.

    Each walks with the way that its wheel makes: while the robot stands nothing is forgotten.
    """

    track: float
    """L [m], as believed."""
    deviation: float = 0.05
    """The standard deviation of each at first."""
    wander: float = 0.03
    """By how much each changes over 1 m [m^-1/2], as a standard deviation."""

    @property
    def names(self) -> tuple[str, str]:
        """As they stand in b."""
        return "left wheel", "right wheel"

    @property
    def deviations(self) -> tuple[float, float]:
        """Of both the same."""
        return self.deviation, self.deviation

    def taken(self, u: Vector, b: Sequence[float]) -> Taken:
        """(1) of the wheels' speeds over ground, (1 + b_L) (v - omega L/2) and so on."""
        left, right = self._rims(u)
        more_left, more_right = b[0] * left, b[1] * right
        v, omega = u.tolist()
        return Taken(
            v + (more_right + more_left) / 2,
            omega + (more_right - more_left) / self.track,
            ((left / 2, -left / self.track), (right / 2, right / self.track)),
        )

    def walk(self, u: Vector) -> tuple[float, float]:
        """In proportion to the speed of the wheel."""
        left, right = self._rims(u)
        return self.wander**2 * abs(left), self.wander**2 * abs(right)

    def _rims(self, u: Vector) -> tuple[float, float]:
        """The wheels' believed speeds over ground [m/s]."""
        v, omega = u.tolist()
        across = omega * self.track / 2
        return v - across, v + across
