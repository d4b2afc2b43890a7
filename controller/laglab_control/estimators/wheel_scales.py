"""Two wheels that are not as large as believed."""

from collections.abc import Sequence
from dataclasses import dataclass

from laglab_control.estimators.parameters import Taken
from laglab_control.model import Vector


@dataclass(frozen=True)
class WheelScales:
    """b = [b_L, b_R]: the left wheel leads 1 + b_L times as far as believed, the right 1 + b_R."""

    track: float
    deviations: tuple[float, float] = (0.05, 0.05)
    walk: tuple[float, float] = (1e-5, 1e-5)

    def taken(self, u: Vector, b: Sequence[float]) -> Taken:
        """(1) with the speeds of the rims scaled."""
        v, omega = u.tolist()
        left, right = b
        across = omega * self.track / 2
        of_left, of_right = v - across, v + across
        more, less = right * of_right, left * of_left
        return Taken(
            v + (more + less) / 2,
            omega + (more - less) / self.track,
            ((of_left / 2, -of_left / self.track), (of_right / 2, of_right / self.track)),
        )


@dataclass(frozen=True)
class WheelScalesAndTrack:
    track: float
    deviations: tuple[float, float, float] = (0.05, 0.05, 0.05)
    walk: tuple[float, float, float] = (1e-5, 1e-5, 1e-5)

    def taken(self, u: Vector, b: Sequence[float]) -> Taken:
        v, omega = u.tolist()
        left, right, wider = b
        across = omega * self.track / 2
        of_left, of_right = v - across, v + across
        more, less = right * of_right, left * of_left
        track = self.track * (1 + wider)
        turn = (of_right + more - of_left - less) / track
        return Taken(
            v + (more + less) / 2,
            turn,
            ((of_left / 2, -of_left / track), (of_right / 2, of_right / track), (0.0, -turn / (1 + wider))),
        )
