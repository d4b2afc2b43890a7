"""The commands in flight: which was sent when, and which is in force when."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from laglab_control.estimators.interface import Applied
from laglab_control.model import Vector
from laglab_control.motion import NOWHERE, Way, joined
from laglab_control.past.log import Log, append, logged
from laglab_control.past.sliding import SlidingProduct
from laglab_control.robot import RobotModel

STAND = np.zeros(2)
"""The input before any command is in force."""
RECENT = 25
"""Echoes that the estimate of n is the median of."""
MEMORY = 1024
"""Ticks for which sent commands are kept."""


class Echo(NamedTuple):
    """What a measurement tells of the command in force on [t_tick, t_{tick+1}).

    `command_tick` is the tick the command was made at, None when there was none and the robot
    stood still.
    """

    tick: int
    u: Vector
    command_tick: int | None


class Flight(NamedTuple):
    """All commands sent by now; the next tick is `tick`. Immutable."""

    tick: int
    sent: Log[Vector]
    """Up to u_{tick-1}."""
    command_delay: int
    """n as the echoes have it: their median, or what the station was told before the first."""
    recent: tuple[int, ...]
    """The last delays that were echoed."""
    known: int
    """Up to this tick it may be known what was in force; after it, it is believed."""
    in_flight: SlidingProduct[Vector, Way]
    """u_{tick-n} ... u_{tick-1}: standing still for what was sent before tick 0."""
    ahead: Way
    """Where they lead."""


def take_off(robot: RobotModel, command_delay: int) -> Flight:
    """Before the first command."""
    nothing: SlidingProduct[Vector, Way] = SlidingProduct(joined, NOWHERE)
    return _rebuilt(robot, Flight(0, logged(), command_delay, (), -1, nothing, NOWHERE))


def send(robot: RobotModel, flight: Flight, u: Vector) -> tuple[Flight, Vector]:
    """With the command of this tick on its way; and the one that is in force until the next."""
    tick, sent, n, recent, known, in_flight, _ = flight
    sent = append(sent, u, MEMORY)
    applied, in_flight = in_flight.push(u, robot.way(u)).pop()
    return Flight(tick + 1, sent, n, recent, known, in_flight, in_flight.product), applied


def hear(robot: RobotModel, flight: Flight, echoes: Sequence[Echo]) -> tuple[Flight, list[Applied]]:
    """With n as the echoes tell; and the inputs that were in force, as far as they are now known.

    When n has changed, what is still on its way is believed to take the new n ticks.
    """
    if not echoes:
        return flight, []
    tick, sent, n, recent, known, in_flight, ahead = flight
    inputs = [Applied(echo.tick, echo.u) for echo in echoes]
    known = max(known, *[echo.tick for echo in echoes])
    recent = (*recent, *[delay for echo in echoes if (delay := _delay(echo)) is not None])[-RECENT:]
    seen = sorted(recent)[len(recent) // 2] if recent else n
    flight = Flight(tick, sent, seen, recent, known, in_flight, ahead)
    if seen == n:
        return flight, inputs
    flight = _rebuilt(robot, flight)
    return flight, inputs + _believed(flight, since=known + 1)


def _delay(echo: Echo) -> int | None:
    """How late the command was, where that makes sense."""
    if echo.command_tick is None or not 0 <= echo.tick - echo.command_tick < MEMORY:
        return None
    return echo.tick - echo.command_tick


def _rebuilt(robot: RobotModel, flight: Flight) -> Flight:
    in_flight = flight.in_flight.emptied()
    for u in _sent_since(flight, flight.tick - flight.command_delay):
        in_flight = in_flight.push(u, robot.way(u))
    return flight._replace(in_flight=in_flight, ahead=in_flight.product)


def _believed(flight: Flight, since: int) -> list[Applied]:
    """What was in force from tick `since` to the present, if each command took n ticks."""
    u = _sent_since(flight, since - flight.command_delay)
    return [Applied(tick, u[tick - since]) for tick in range(since, flight.tick)]


def _sent_since(flight: Flight, tick: int) -> list[Vector]:
    """u_tick and all after it; standing still for what was sent before tick 0."""
    count = flight.tick - tick
    items, length = flight.sent
    sent = items[max(length - count, 0) : length]
    return [STAND] * (count - len(sent)) + sent
