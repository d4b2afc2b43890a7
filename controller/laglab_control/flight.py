"""The commands in flight: which was sent when, and which is in force when."""

import math
from collections.abc import Sequence
from operator import mul
from typing import NamedTuple

from laglab_control.estimators.interface import InForce
from laglab_control.laws.interface import STAND, Demand
from laglab_control.model import Vector
from laglab_control.motion import NOWHERE, Way, joined
from laglab_control.past.log import Log, append, logged
from laglab_control.past.memory import MEMORY
from laglab_control.past.sliding import SlidingProduct
from laglab_control.plans import Plans, no_plans
from laglab_control.robot import Ways

RECENT = 25
"""So many echoes tell delays of which n is the median."""
GIVEN_UP = 256
"""Ticks after which an input that was not told is taken to have been as believed."""
STOOD = 25
"""A robot that says for n ticks, and for more than this beyond, that it stands still though it was
to drive does not obey: when a link comes back, and at the start, it rests for n."""
FEW = 20
"""So many ticks whose input may have been another one make no difference that shows."""


AT_REST = STAND.tolist()


class Echo(NamedTuple):
    """What a measurement tells of the command in force on [t_tick, t_{tick+1}).

    `command_tick` is the tick the command was made at, None when there was none and the robot
    stood still.
    """

    tick: int
    u: Vector
    command_tick: int | None


class Told(NamedTuple):
    """What the echoes have told so far."""

    recent: tuple[int, ...] = ()
    """The last delays of commands that had just come into force."""
    newest: int = -1
    """The tick of the newest command of those."""
    known: int = -1
    """Up to this tick what was in force may be known; later it is only believed."""
    missing: tuple[int, ...] = ()
    """The ticks up to `known` of which nothing was told, in order."""
    in_force: Vector = STAND
    """The input at `known`."""
    before: Vector = STAND
    """The last input known before the first that is missing."""
    usual: int | None = None
    """So many inputs were only believed when the last echo came; None before one."""
    spread: float = 0.0
    """The standard deviation of the `recent` delays [ticks]."""
    stood: int = 0
    """For so many ticks up to `known` the robot has told again and again that it stands still."""

    def usual_delay(self, otherwise: int) -> int:
        """n, the median; before the first echo what was believed `otherwise`."""
        if not self.recent:
            return otherwise
        return sorted(self.recent)[len(self.recent) // 2] if self.spread else self.recent[0]

    def after(
        self, tick: int, echoes: Sequence[Echo], recalled: Sequence[InForce]
    ) -> "tuple[Told, list[InForce]]":
        """With what came at `tick`; and the inputs that are known by it."""
        told = self
        inputs: list[InForce] = []
        for echo in echoes:
            told = _heard(told, echo, tick)
            inputs.append(InForce(echo.tick, echo.u))
        inputs += recalled
        return _found(told, inputs, tick) if told.missing else told, inputs

    def has_stood(self, n: int) -> bool:
        """Whether the robot has stood still for longer than it takes to get going again."""
        return self.stood > STOOD + n

    @property
    def settled(self) -> int:
        """Up to this tick what was in force is known, but for a few ticks, or given up."""
        missing = [tick for tick in self.missing if tick > self.known - GIVEN_UP]
        return missing[0] - 1 if len(missing) > FEW else self.known


class Sent(NamedTuple):
    """A command on its way, and the sums of all inputs sent up to it."""

    u: Vector
    v: float
    omega: float


class Sums(NamedTuple):
    """Of several inputs."""

    v: float
    omega: float


class Flight(NamedTuple):
    """All commands sent by now; the next tick is `tick`. Immutable."""

    tick: int
    sent: Log[Sent]
    """Up to u_{tick-1}."""
    command_delay: int
    """n as the echoes have it: their median, or what the station was told before the first."""
    told: Told
    in_flight: SlidingProduct[Vector, Way[float]]
    """u_{tick-n} ... u_{tick-1}: standing still for what was sent before tick 0."""
    ahead: Way[float]
    """Where they lead."""
    plans: Plans | None = None
    """Where commands plan ahead: then n is what they are made for, and what is `sent` is what the
    robot will make of them."""
    stands: bool = False
    """Whether the robot stands still whatever it is sent, and is believed to go on so: it was
    disarmed or stopped, refuses what it is sent, or does not get it."""

    @property
    def usual_delay(self) -> int:
        """After how many ticks a command usually comes into force."""
        return self.command_delay + (self.plans.behind if self.plans else 0)


def take_off(robot: Ways, command_delay: int, horizon: int = 0) -> Flight:
    """Before the first command; `horizon` ticks are planned with each."""
    nothing: SlidingProduct[Vector, Way[float]] = SlidingProduct(joined, NOWHERE)
    plans = no_plans(horizon) if horizon else None
    flight = Flight(0, logged(), command_delay, Told(), nothing, NOWHERE, plans)
    return _rebuilt(robot, flight)


def send(
    robot: Ways, flight: Flight, u: Vector, plan: Sequence[Demand] = ()
) -> tuple[Flight, Vector]:
    """With the command of this tick on its way; and the input that is in force until the next.

    Where commands plan ahead, `plan` begins with the command itself.
    """
    if flight.stands and _nobody_tells(flight):
        flight = _rebuilt(robot, flight._replace(stands=False))
    tick, sent, n, told, in_flight, _, plans, stands = flight
    if plans:
        plans, u = plans.send(plan)
    sent = append(sent, _sent_after(sent, u), MEMORY)
    believed = STAND if stands else u
    applied, in_flight = in_flight.slide(believed, robot.way(believed))
    ahead = in_flight.product
    return Flight(tick + 1, sent, n, told, in_flight, ahead, plans, stands), applied


def hear(
    robot: Ways,
    flight: Flight,
    echoes: Sequence[Echo],
    recalled: Sequence[InForce] = (),
) -> tuple[Flight, list[InForce]]:
    """With n as the echoes tell; and the inputs that were in force, as far as they are now known:
    from the echoes, and from what the robot was asked to recall.

    When n has changed, what is still on its way is believed to take the new n ticks; and when the
    robot turns out not to obey, or to obey again, what is on its way is believed to be in vain, or
    not.
    """
    if not (echoes or recalled):
        return flight, []
    tick, sent, n, told, in_flight, ahead, plans, stood = flight
    told, inputs = told.after(tick, echoes, recalled)
    seen = told.usual_delay(otherwise=flight.usual_delay)
    if plans:  # the robot is that far on in them
        plans, seen = plans.late(max(seen - n, 0)), min(seen, n)
    stands = told.has_stood(seen) and _was_to_drive(flight, told.known)
    flight = Flight(tick, sent, seen, told, in_flight, ahead, plans, stands)
    if seen == n and stands == stood:
        return flight, inputs
    flight = _rebuilt(robot, flight)
    return flight, inputs + _believed(flight, since=told.known + 1)


def _heard(told: Told, echo: Echo, tick: int) -> Told:
    """With one more echo. A command that is held, for want of a newer one, tells nothing of n."""
    recent, newest, known, missing, in_force, before, usual, spread, stood = told
    made = echo.command_tick
    if made is not None and made > newest and 0 <= (delay := echo.tick - made) < MEMORY:
        newest = made
        if spread or delay not in recent or len(recent) < RECENT:
            recent = (*recent, delay)[-RECENT:]
            spread = _deviation(recent) if spread or delay != recent[0] else 0.0
    if echo.tick <= known:
        return Told(recent, newest, known, missing, in_force, before, usual, spread, stood)
    if echo.tick > known + 1:
        before = before if missing else in_force
        missing += tuple(range(max(known + 1, echo.tick - MEMORY), echo.tick))
    usual = tick - 1 - echo.tick
    gap = echo.tick - known
    stood = (stood + gap if gap <= FEW else 1) if echo.u.tolist() == AT_REST else 0
    return Told(recent, newest, echo.tick, missing, echo.u, before, usual, spread, stood)


def _nobody_tells(flight: Flight) -> bool:
    """Whether it is so long ago that the robot stood still that it may drive again."""
    return flight.tick - 1 - flight.told.known > (flight.told.usual or 0) + FEW


def _was_to_drive(flight: Flight, known: int) -> bool:
    """Whether the commands for tick `known`, and for STOOD ticks before, both meant it."""
    return all(sent_for(flight, tick).tolist() != AT_REST for tick in (known - STOOD, known))


def _deviation(delays: tuple[int, ...]) -> float:
    count, total = len(delays), sum(delays)
    return math.sqrt(count * sum(map(mul, delays, delays)) - total**2) / count


def _found(told: Told, inputs: Sequence[InForce], tick: int) -> Told:
    """Without the ticks that are no longer missing, or that nobody will tell of any more."""
    now_known = {applied.tick for applied in inputs}
    missing = tuple(
        each for each in told.missing if each not in now_known and each >= tick - MEMORY
    )
    return told._replace(missing=missing)


def _rebuilt(robot: Ways, flight: Flight) -> Flight:
    in_flight = flight.in_flight.emptied()
    for u in _believed_since(flight, flight.tick - flight.command_delay):
        in_flight = in_flight.push(u, robot.way(u))
    return flight._replace(in_flight=in_flight, ahead=in_flight.product)


def _believed(flight: Flight, since: int) -> list[InForce]:
    """What was in force from tick `since` to the present, if each command took n ticks."""
    u = _believed_since(flight, since - flight.command_delay)
    return [InForce(tick, u[tick - since]) for tick in range(since, flight.tick)]


def _sent_after(sent: Log[Sent], u: Vector) -> Sent:
    v, omega = u.tolist()
    if not sent.length:
        return Sent(u, v, omega)
    before = sent.newest
    return Sent(u, before.v + v, before.omega + omega)


def sent_for(flight: Flight, tick: int) -> Vector:
    """The input (2,) that is in force on [t_tick, t_{tick+1}), tick < `flight.tick`, if the robot
    obeys."""
    items, length = flight.sent
    index = length - (flight.tick - (tick - flight.command_delay))
    return items[index].u if 0 <= index < length else STAND


def believed_sum(flight: Flight, since: int) -> Sums:
    """Of the inputs believed to have been in force from tick `since` to the present."""
    if flight.stands:
        return Sums(0.0, 0.0)
    last = flight.sent.length - 1 - flight.command_delay
    newest, oldest = _sum_up_to(flight, last), _sum_up_to(flight, last - (flight.tick - since))
    return Sums(newest.v - oldest.v, newest.omega - oldest.omega)


def _sum_up_to(flight: Flight, index: int) -> Sums:
    """Over all that was sent up to this place in `sent`; nothing before the first."""
    if index < 0:
        return Sums(0.0, 0.0)
    _, v, omega = flight.sent.items[index]
    return Sums(v, omega)


def _believed_since(flight: Flight, tick: int) -> list[Vector]:
    """u_tick and all after it; standing still for what was sent before tick 0, or in vain."""
    count = flight.tick - tick
    if flight.stands:
        return [STAND] * count
    items, length = flight.sent
    sent = [each.u for each in items[max(length - count, 0) : length]]
    return [STAND] * (count - len(sent)) + sent
