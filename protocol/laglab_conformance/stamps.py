"""The items on what a robot tells at each tick: in which order, how much, of which command."""

import math
from itertools import pairwise

from laglab_conformance.items import Item
from laglab_conformance.robot import (
    CREEP,
    ROUNDED,
    RobotSession,
    batches,
    creep,
    measurements,
    newest_measurement,
)
from laglab_conformance.session import DoesNotApplyError
from laglab_protocol import NO_COMMAND, Applied, Measurement, Tick

RARE = 0.05
"""The share of the ticks of which a line may lose something."""
APART = 0.001
"""[s] What comes closer together may as well have come in one piece."""


def tick_comes_first(session: RobotSession) -> bool:
    """Whether most measurements come nearer to the tick before them than to the one after them.

    Only on a line that is full are the two equally far.
    """
    early = late = 0
    for since, until in _gaps(session):
        late += since + APART < until
        early += until + APART < since
    return late > early


def _gaps(session: RobotSession) -> list[tuple[float, float]]:
    """Of each measurement, how long after a tick it came, and how long before one [s]."""
    gaps, last, waiting = [], -math.inf, list[float]()
    for frame, at in zip(session.heard, session.heard_at, strict=True):
        if isinstance(frame.message, Measurement | Applied):
            waiting.append(at)
        elif isinstance(frame.message, Tick):
            gaps += [(each - last, at - each) for each in waiting]
            last, waiting = at, []
    return gaps


def _in_order(session: RobotSession) -> str | None:
    return "they come after it" if tick_comes_first(session) else None


def _counts(session: RobotSession) -> str | None:
    if tick_comes_first(session):
        raise DoesNotApplyError("they come after it")
    told = batches(session)
    short = 0
    for (batch, last), lost in zip(told, _lost(session), strict=True):
        missing = last.measurements - len(batch)
        short += missing != 0
        if missing and (missing != lost or short > RARE * len(told)):
            return f"{last} came after {len(batch)} of them"
    return None


def _lost(session: RobotSession) -> list[int]:
    """Before every tick but the first, how many frames that the robot numbered did not come: a
    line may lose one now and then, and that is not the robot's fault."""
    lost, missed, number = list[int](), 0, None
    for frame in session.heard:
        if (frame.system, frame.component) == session.peer:
            missed += 0 if number is None else (frame.sequence - number - 1) & 0xFF
            number = frame.sequence
        if isinstance(frame.message, Tick):
            lost.append(missed)
            missed = 0
    return lost[1:]


def _sound(session: RobotSession) -> str | None:
    """A station can make nothing of any other."""
    for batch, last in batches(session):
        for each in batch:
            if not isinstance(each, Measurement):
                continue
            if each.tick > last.tick:
                return f"tick {last.tick} brings a measurement that was sampled at tick {each.tick}"
            if not all(map(math.isfinite, (each.x, each.y, each.theta))):
                return f"the measurement of tick {each.tick} is ({each.x}, {each.y}, {each.theta})"
    return None


def _echoes(session: RobotSession) -> str | None:
    """Each measurement names an earlier command that was sent; none tells of motion but by commands
    from before ours, or by our creeping one, under its own name."""
    first = session.told(Tick)[0].tick
    stamp = session.tick
    told = creep(session)
    if told is not None and told.command_tick != stamp:
        return f"what command {stamp} commanded is told of command {told.command_tick}"
    newest_measurement(session)
    for each in measurements(session):
        others = NO_COMMAND < each.command_tick < first
        if not NO_COMMAND <= each.command_tick < max(each.tick, 0):
            return f"the measurement of tick {each.tick} names command {each.command_tick}"
        if not (others or each.command_tick in {NO_COMMAND, *session.said}):
            return f"the measurement of tick {each.tick} names a command that nobody sent"
        commanded = -CREEP * ROUNDED <= each.v <= CREEP * (1 + ROUNDED) and each.omega == 0.0
        if not (commanded or others):
            return f"the measurement of tick {each.tick} moves, though nobody commanded it"
    return None


def no_earlier(session: RobotSession) -> str | None:
    """From measurement to measurement the command in force is the same, or a later one."""
    for before, after in pairwise(measurements(session)):
        if after.command_tick < before.command_tick:
            return f"command {after.command_tick} is in force after {before.command_tick}"
    return None


STAMPED = [
    Item("ticks", "measurements come before their tick", _in_order),
    Item("ticks", "the tick counts its measurements", _counts),
    Item("ticks", "measurements are finite, and of no later tick", _sound),
    Item("ticks", "measurements tell the command in force", _echoes),
]
