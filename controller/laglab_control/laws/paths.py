"""Paths that a law may follow: where the robot is to be when, and how fast."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, NamedTuple, Protocol

import numpy as np

from laglab_control.errors import ConfigError
from laglab_control.limits import Limit, check
from laglab_control.model import Matrix, Vector

OUTLINE = 400
"""Points by which a closed path is drawn."""
Measure = Annotated[float, Limit(1e-9, most=1e9)]
"""Of a shape [m, m/s]: with one beyond, what follows from it is no number."""


class Reference(NamedTuple):
    """Pose [m, m, rad] and speeds [m/s, rad/s] that are wanted at a time."""

    x: float
    y: float
    theta: float
    v: float
    omega: float


class Path(Protocol):
    """Where the robot is to be: a pure function of time."""

    def sampled(self, times: Vector) -> Matrix:
        """At `times` (n,) [s]: x, y, theta, v, omega in each row (n, 5)."""
        ...

    def outline(self) -> Matrix:
        """Where it leads in the plane (k, 2) [m]."""
        ...

    def at(self, time: float) -> Reference:
        """At one time [s]."""
        return Reference(*self.sampled(np.array([time]))[0].tolist())


@dataclass(frozen=True)
class Circle(Path):
    """Counter-clockwise at constant `speed` [m/s], from the point on the right of the centre.

    `centre` [m, m], `radius` [m]. Raises ConfigError, naming the field, for a value that cannot be.
    """

    centre: tuple[float, float]
    radius: Measure
    speed: Measure

    def __post_init__(self) -> None:
        check(self)

    def sampled(self, times: Vector) -> Matrix:
        """At `times` (n,)."""
        rate = self.speed / self.radius
        angle = rate * times
        x = self.centre[0] + self.radius * np.cos(angle)
        y = self.centre[1] + self.radius * np.sin(angle)
        still = np.zeros_like(angle)
        return np.stack((x, y, angle + math.pi / 2, still + self.speed, still + rate), axis=1)

    def outline(self) -> Matrix:
        """Once around."""
        return self.sampled(np.linspace(0, math.tau * self.radius / self.speed, OUTLINE))[:, :2]


@dataclass(frozen=True)
class Eight(Path):
    """A lying figure of eight, `width` [m] wide and half as high, from its middle to the upper
    right. `speed` [m/s] is that in the middle, where the robot is fastest; `centre` [m, m].

    Raises ConfigError, naming the field, for a value that cannot be.
    """

    centre: tuple[float, float]
    width: Measure
    speed: Measure

    def __post_init__(self) -> None:
        check(self)

    @property
    def _rate(self) -> float:
        """[rad/s]: x = w/2 sin s, y = w/4 sin 2s with s the rate times t."""
        return math.sqrt(2) * self.speed / self.width

    def sampled(self, times: Vector) -> Matrix:
        """At `times` (n,)."""
        half, rate = self.width / 2, self._rate
        s = rate * times
        x, y = self.centre[0] + half * np.sin(s), self.centre[1] + half / 2 * np.sin(2 * s)
        dx, dy = half * rate * np.cos(s), half * rate * np.cos(2 * s)
        ddx, ddy = -half * rate**2 * np.sin(s), -2 * half * rate**2 * np.sin(2 * s)
        theta = np.arctan2(dy, dx)
        theta = np.where(theta > math.pi / 2, theta - math.tau, theta)  # it never looks straight up
        squared = dx**2 + dy**2
        return np.stack((x, y, theta, np.sqrt(squared), (dx * ddy - dy * ddx) / squared), axis=1)

    def outline(self) -> Matrix:
        """Once along it."""
        return self.sampled(np.linspace(0, math.tau / self._rate, OUTLINE))[:, :2]


def unwound(times: Vector, theta: Vector, omega: Vector) -> Vector:
    """Headings (n,) [rad] at `times` (n,) [s] without the turns by which they jump from row to row.

    A jump is one if less those turns it is where omega (n,) [rad/s] leads, to a quarter of a turn.
    """
    beyond = np.diff(theta) - np.diff(times) * (omega[1:] + omega[:-1]) / 2
    turns = 2 * np.pi * np.round(beyond / (2 * np.pi))
    jumps = np.where(np.abs(beyond - turns) < np.pi / 2, turns, 0.0)
    return theta - np.concatenate(([0.0], np.cumsum(jumps)))


@dataclass(frozen=True, eq=False)
class Waypoints(Path):
    """Linear between rows x, y, theta, v, omega (n, 5) at growing `times` (n,) [s]; where theta
    jumps by a turn, as a recorded one does, it goes on without (`unwound`).

    Before the first and after the last row the robot is to stand there. Raises ConfigError when
    rows and times do not fit, when one is not finite, or when the times do not grow.
    """

    times: Vector
    rows: Matrix

    def __post_init__(self) -> None:
        if self.rows.shape != (len(self.times), 5) or not len(self.times):
            raise ConfigError("a path must have a row of x, y, theta, v, omega for each time")
        if not (np.isfinite(self.times).all() and np.isfinite(self.rows).all()):
            raise ConfigError("a path must be of finite numbers")
        if not (np.diff(self.times) > 0).all():
            last = self.times[int(np.argmin(np.diff(self.times) > 0)) + 1]
            raise ConfigError(f"the times of a path must grow: {last} is not after the one before")

    @cached_property
    def _columns(self) -> Matrix:
        """(6, n), the times first: each in one piece, or it would be copied at every tick."""
        x, y, theta, v, omega = self.rows.T
        return np.vstack((self.times, x, y, unwound(self.times, theta, omega), v, omega))

    def sampled(self, times: Vector) -> Matrix:
        """At `times` (n,)."""
        own, *columns = self._columns
        columns = [np.interp(times, own, column) for column in columns]
        under_way = (times >= self.times[0]) & (times <= self.times[-1])
        return np.stack((*columns[:3], *(under_way * speed for speed in columns[3:])), axis=1)

    def outline(self) -> Matrix:
        """Its points."""
        return self.rows[:, :2]
