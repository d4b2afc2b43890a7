"""What a filter may learn of the robot besides its pose: how it makes speeds of its input."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from laglab_control.model import Vector


class Taken(NamedTuple):
    """An input as the robot takes it: v [m/s], omega [rad/s], and their derivatives by each
    parameter."""

    v: float
    omega: float
    by: Sequence[tuple[float, float]]


class Parameters(Protocol):
    """b (p,): how the robot differs from its model; all 0 where it does not."""

    @property
    def names(self) -> Sequence[str]:
        """What each is called."""
        ...

    @property
    def deviations(self) -> Sequence[float]:
        """How far from 0 each is expected at first: standard deviations (p,)."""
        ...

    def taken(self, u: Vector, b: Sequence[float]) -> Taken:
        """What the robot makes of the input u = [v, omega] [m/s, rad/s]."""
        ...

    def walk(self, u: Vector) -> Sequence[float]:
        """The variances (p,) that a second with u in force adds to them [1/s]: they walk at
        random."""
        ...
