"""Which command the robot follows: a state machine without a clock, one state a tick.

    WAITING    no command yet: the robot stands still
    DRIVING    the newest command is in force, or what it plans for this tick
    STOPPING   nothing fresh for `link_timeout`, nor planned: the speeds ramp to 0 and stay there

A fresh command, one that is newer than the one in force, finite and within the limits, leads from
every mode to DRIVING.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum, auto
from typing import Annotated

from laglab_gateway.values import Positive, Seconds, checked, described
from laglab_protocol import NO_COMMAND, Command, Planned, Speeds

__all__ = [
    "FASTEST",
    "Drive",
    "Rejection",
    "Safety",
    "follow",
    "rejection",
    "speeds",
    "supervise",
]

FASTEST = 1e6
"""[m/s], [rad/s] Nothing drives faster, whatever the limits: the wheels' speeds must be finite."""


class Mode(Enum):
    """See the table above."""

    WAITING = auto()
    DRIVING = auto()
    STOPPING = auto()


class Rejection(Enum):
    """Why a command is not followed."""

    NOT_FINITE = "not finite"
    OUT_OF_LIMITS = "out of limits"
    STALE = "stale"
    LATE = "late"
    INCOMPLETE = "incomplete"


@checked
class Safety:
    """The robot's own limits, and its failsafe."""

    v_limit: Annotated[
        Positive | None, described("m/s", "The robot refuses a command that is faster.")
    ] = None
    omega_limit: Annotated[
        Positive | None, described("rad/s", "The robot refuses a command that turns faster.")
    ] = None
    link_timeout: Annotated[
        Seconds, described("s", "Without a fresh command for so long the robot stops by itself.")
    ] = 0.5
    ramp: Annotated[Seconds, described("s", "How long it then takes to a standstill.")] = 0.5


@dataclass(frozen=True)
class Drive:
    """What is in force at a tick.

    `v` and `omega` are what the last command was, or the last that it planned; `fresh` is the tick
    at which it was accepted, or that its plan ends with; `plan` is what comes before that, from
    the tick `planned` on.
    """

    mode: Mode = Mode.WAITING
    v: float = 0.0
    omega: float = 0.0
    command_tick: int = NO_COMMAND
    fresh: int = 0
    plan: tuple[Speeds, ...] = ()
    planned: int = 0


def rejection(
    drive: Drive, command: Command, safety: Safety, following: Iterable[Speeds] = ()
) -> Rejection | None:
    """Why `command`, with what it plans to follow it, is not to be followed; None when it is."""
    for v, omega in (command.speeds, *following):
        if not (math.isfinite(v) and math.isfinite(omega)):
            return Rejection.NOT_FINITE
        if _beyond(v, safety.v_limit) or _beyond(omega, safety.omega_limit):
            return Rejection.OUT_OF_LIMITS
    return Rejection.STALE if command.tick <= drive.command_tick else None


def _beyond(value: float, limit: float | None) -> bool:
    return abs(value) > (FASTEST if limit is None else min(limit, FASTEST))


def follow(command: Command, tick: int) -> Drive:
    """A command that was not refused comes into force at `tick`."""
    return Drive(Mode.DRIVING, command.v, command.omega, command.tick, tick)


def follow_plan(planned: Planned, tick: int) -> Drive:
    """The same with a plan: each tick, `tick` included, gets what the plan has for it."""
    command, first, following = planned
    if first is None or not following:
        return follow(command, tick)
    plan = (command.speeds, *following)
    ends = max(first + len(following), tick)
    return Drive(Mode.DRIVING, *plan[-1], command.tick, ends, plan, first)


def supervise(drive: Drive, tick: int, sample_time: float, safety: Safety) -> Drive:
    """The drive at `tick` if nothing fresh has come: after `link_timeout` it stops."""
    if drive.mode is not Mode.DRIVING:
        return drive
    silent = (tick - drive.fresh) * sample_time
    return replace(drive, mode=Mode.STOPPING) if silent >= safety.link_timeout else drive


def speeds(drive: Drive, tick: int, sample_time: float, safety: Safety) -> tuple[float, float]:
    """v [m/s] and ω [rad/s] in force on [t_tick, t_{tick+1})."""
    match drive.mode:
        case Mode.DRIVING:
            if tick < drive.fresh:
                return drive.plan[tick - drive.planned]
            return drive.v, drive.omega
        case Mode.STOPPING:
            since = (tick - drive.fresh) * sample_time - safety.link_timeout
            share = max(0.0, 1 - since / safety.ramp) if safety.ramp else 0.0
            return share * drive.v, share * drive.omega
        case _:
            return 0.0, 0.0
