"""The items of a robot that runs by its own clock and follows the newest command it has heard."""

import time
from functools import partial
from itertools import pairwise

from laglab_conformance.ending import ENDS
from laglab_conformance.framing import RECEIVING, SENDING, SIGNING
from laglab_conformance.items import Item
from laglab_conformance.planning import PLANS
from laglab_conformance.robot import (
    BEGINS,
    CREEP,
    NOT_FINITE,
    NOT_MEANT,
    RECALLS,
    ROUNDED,
    SETTINGS,
    RobotSession,
    creep,
    creeps,
    is_after,
)
from laglab_conformance.services import SERVICES
from laglab_conformance.session import DoesNotApplyError, NoReactionError
from laglab_conformance.stamps import STAMPED
from laglab_protocol import Frame, Measurement, Tick

UNEVEN = 0.25
"""By how much the ticks a second may differ within a few seconds, as a share."""

CALM = 0.1
"""A share of the time that ticks may pause for, as ours do when we are held up, without hiding
that they are uneven; else we measure again ..."""
MOST_PAIRS = 3
"""... so often in all, and judge by the calmest."""

AT_ONCE = 0.0003
"""[s] What comes sooner was there already."""
MOST_PILED_UP = 1000

COMMAND_EVERY = 0.05
"""[s] So often a robot is sure not to miss its station."""

STAMPS_APART = 3

LINK_TIMEOUT = 0.5
"""[s] After so long without a command a robot begins to slow down."""


class FreeRunningSession(RobotSession):
    """The robot's station. The stimulus is a command stamped with the newest tick heard, the
    reaction a measurement that tells of it, or of a later one, as the command in force.

    A robot that names a command by a stamp that is one off has reacted: which item that fails is
    another question. So commands are stamped three ticks apart.
    """

    followed = 0
    """The stamp of the last command that it has followed."""

    def is_reaction(self, frame: Frame) -> bool:
        told = frame.message
        return isinstance(told, Measurement) and told.command_tick >= self.tick - 1

    def go_on(self) -> None:
        """To a tick that is later than all commands by three. Raises NoReactionError."""
        self.followed = self.tick
        super().go_on()
        while self.tick < max(self.said, default=-STAMPS_APART) + STAMPS_APART:
            if not self.listen(self.waits.react, partial(is_after, self.tick)):
                raise NoReactionError(f"no tick comes after {self.tick}")
            super().go_on()

    def exchange(self) -> None:
        """With the newest tick: what was refused may have used up the one before."""
        self.go_on()
        super().exchange()


def _goes_on(session: FreeRunningSession) -> str | None:
    for _ in range(3):
        last = session.told(Tick)[-1].tick
        if not session.listen(session.waits.react, partial(is_after, last)):
            return f"no tick comes after {last}, though it is to wait for nobody"
    return None


def _even(session: FreeRunningSession) -> str | None:
    session.exchange()
    pairs: list[tuple[float, float, float]] = []
    while len(pairs) < MOST_PAIRS and not any(paused < CALM for paused, _, _ in pairs):
        (before, pause), (after, other_pause) = _rate(session), _rate(session)
        pairs.append((pause + other_pause, before, after))
    session.go_on()
    paused, before, after = min(pairs)
    if abs(before - after) > (UNEVEN + paused) * max(before, after):
        return f"{before:.0f} ticks a second, then {after:.0f}"
    return None


def _rate(session: FreeRunningSession) -> tuple[float, float]:
    """Ticks a second, over half as long as a reaction may take; and which share of that time the
    longest pause between ticks took, for they may come several at once."""
    began, first = _next_tick(session)
    start, over = len(session.heard), began + session.waits.react / 2
    while time.monotonic() < over:
        # As a station does: without commands a robot may slow down.
        session.send(session.command(session.told(Tick)[-1].tick))
        session.listen(COMMAND_EVERY, lambda _: False)
    ended, last = _next_tick(session)
    heard = zip(session.heard[start:], session.heard_at[start:], strict=True)
    at = [began, *(when for frame, when in heard if isinstance(frame.message, Tick))]
    longest = max(after - before for before, after in pairwise(at))
    return (last - first) / (ended - began), longest / (ended - began)


def _next_tick(session: FreeRunningSession) -> tuple[float, int]:
    """When the next tick came that had to be waited for, and which: what had piled up tells no
    time. Raises NoReactionError."""
    for _ in range(MOST_PILED_UP):
        asked = time.monotonic()
        if session.wait_for(Tick, session.waits.react) is None:
            raise NoReactionError("no tick comes any more")
        if time.monotonic() - asked > AT_ONCE:
            break
    return time.monotonic(), session.told(Tick)[-1].tick


def _earlier(session: FreeRunningSession) -> str | None:
    """Stamped earlier than the newest, and later than all that were sent before that."""
    session.exchange()
    earlier = session.followed - STAMPS_APART + 1
    session.send(session.command(earlier))
    if session.listen(session.refusal, partial(_tells_of, earlier)):
        return f"command {earlier} was followed after {session.followed}"
    return None


def _same(session: FreeRunningSession) -> str | None:
    """Standing still by one command, it does not creep by another with the same stamp."""
    _creep(session)
    session.exchange()
    session.send(session.command(session.followed, v=CREEP))
    if session.listen(session.refusal, creeps):
        return f"command {session.followed} was followed a second time"
    return None


def _stops(session: FreeRunningSession) -> str | None:
    """Creeping, it is left alone: it must come to a standstill, and the next command ends that."""
    _creep(session)
    began = time.monotonic()
    if not session.listen(LINK_TIMEOUT + session.waits.react, _stands):
        return f"{time.monotonic() - began:.1f} s after the last command it still follows it"
    if creep(session) is None:
        return "it has stopped, and does not follow the next command"
    session.exchange()
    return None


def _creep(session: FreeRunningSession) -> None:
    if creep(session) is None:
        raise DoesNotApplyError(f"it cannot be tried standing still: {CREEP} m/s it does not drive")


def _stands(frame: Frame) -> bool:
    told = frame.message
    return isinstance(told, Measurement) and abs(told.v) < CREEP * ROUNDED and told.omega == 0.0


def _tells_of(stamp: int, frame: Frame) -> bool:
    return isinstance(frame.message, Measurement) and frame.message.command_tick == stamp


def _one_by_one(session: FreeRunningSession) -> str | None:
    for before, after in pairwise(session.told(Tick)):
        if after.tick != before.tick + 1:
            return f"tick {after.tick} follows tick {before.tick}"
    return None


ITEMS: list[Item[FreeRunningSession]] = [
    BEGINS,
    Item("ticks", "it waits for no answer", _goes_on),
    Item("timing", "its ticks come evenly", _even),
    *RECEIVING,
    Item("ticks", "a command that is older than the newest is not followed", _earlier),
    Item("ticks", "a command stamped like the newest is not followed", _same),
    Item("ticks", "it stops when no command comes", _stops),
    *NOT_MEANT,
    NOT_FINITE,
    SETTINGS,
    RECALLS,
    *PLANS,
    *SERVICES,
    *SIGNING,
    Item("ticks", "each tick comes once", _one_by_one),
    *STAMPED,
    *SENDING,
    *ENDS,
]
