"""The commands of many robots in flight, each n ticks late: which is in force, where they lead."""

from typing import NamedTuple

import numpy as np

from laglab_control.batch.odometry import Leg, Rotation, at_origin, driven
from laglab_control.batch.robots import joined
from laglab_control.batch.rows import Heading, Pose, Speeds, headings
from laglab_control.config import StationConfig
from laglab_control.motion import NOWHERE, Way
from laglab_control.past.sliding import SlidingProduct


class Flight(NamedTuple):
    """All that is sent, and where what is in flight leads."""

    legs: tuple[Leg, ...]
    """From the one that is in force on; no more, for a cache does not hold much of many robots."""
    way: SlidingProduct[None, Pose] | None
    """To the last bit; None: as the odometer has it."""

    @property
    def applied(self) -> Leg:
        """The commands that were in force on the tick before the present."""
        return self.legs[0]


def take_off(config: StationConfig, robots: int, exact: bool) -> Flight:
    """Before the first commands the robots stand still."""
    legs = (at_origin(robots),) * (config.command_delay + 1)
    if not exact:
        return Flight(legs, None)
    nowhere: Pose = Way(*[np.full(1, each) for each in NOWHERE])
    way: SlidingProduct[None, Pose] = SlidingProduct(joined, nowhere)
    for _ in range(config.command_delay):
        way = way.push(None, nowhere)
    return Flight(legs, way)


def sent(config: StationConfig, flight: Flight, u: Speeds) -> Flight:
    """With the commands of a tick, and without those that come into force now."""
    legs, way = flight
    legs = (*legs[1:], driven(config.model, legs[-1], u))
    if way is not None:
        Ts = config.model.sample_time
        _, way = way.push(None, Way(Ts * u.v, np.zeros(1), Ts * u.omega)).pop()
    return Flight(legs, way)


def place_of(flight: Flight, pose: Pose, turn: Rotation) -> tuple[Pose, Heading]:
    """(29): where the robots will be when the commands that are now made come into force."""
    then = flight.legs[-1]
    if flight.way is not None:
        there = joined(pose, flight.way.product)
        return there, headings(there.theta)
    way = turn.way(flight.applied, then)
    there = Way(pose.x + way.x, pose.y + way.y, pose.theta + way.theta)
    return there, turn.of(then.heading)
