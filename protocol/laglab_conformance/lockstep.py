"""The items of a robot in lock-step: each of its ticks waits for the command stamped with it."""

import time
from collections.abc import Callable
from itertools import pairwise

from laglab_conformance.ending import ENDS, GIVES_UP, SILENCE
from laglab_conformance.forge import Forged
from laglab_conformance.framing import RECEIVING, SENDING, SIGNING
from laglab_conformance.items import SOON, Item, reacts_soon, refused
from laglab_conformance.planning import PLANS
from laglab_conformance.robot import (
    BEGINS,
    NOT_FINITE,
    NOT_MEANT,
    RECALLS,
    SETTINGS,
    Batch,
    RobotSession,
    batches,
    is_after,
)
from laglab_conformance.services import SERVICES
from laglab_conformance.session import DoesNotApplyError, NoReactionError
from laglab_conformance.stamps import STAMPED, no_earlier, tick_comes_first
from laglab_protocol import STATION_HEARTBEAT, Frame, Planned, Tick

NEVER = 10**6
"""[ticks] What is planned for so much later never comes into force."""


class LockstepSession(RobotSession):
    """The robot's station. The reaction to the command for a tick is the next tick."""

    longest_delay = 64

    def is_reaction(self, frame: Frame) -> bool:
        return is_after(self.tick, frame)

    def listen(self, seconds: float, until: Callable[[Frame], bool]) -> Frame | None:
        """A robot gives up who says nothing: in a long wait it hears a heartbeat now and then."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > SILENCE / 2:
            if found := super().listen(min(left, SILENCE / 2), until):
                return found
            if not (self.over or self.silent):
                self.send(STATION_HEARTBEAT)
        return super().listen(left, until)

    def watch(self, until: Callable[[Frame], bool], seconds: float) -> Frame | None:
        """From tick to tick: each is answered by a plan that is meant for much later."""
        del seconds  # it goes by ticks
        seen = len(self.heard)
        for _ in range(self.longest_delay):
            if not self.reacts(self.waits.react):
                raise NoReactionError(f"no reaction to a plan at tick {self.tick}")
            if found := next(filter(until, self.heard[seen:]), None):
                return found
            later = Planned(self.command(self.tick, plan=1), self.tick + NEVER, ((0.0, 0.0),))
            self.send(*later.frames(), later.command)
        self.reacts(self.waits.react)
        return None


def _begins_at_zero(session: LockstepSession) -> str | None:
    first = session.told(Tick)[0].tick
    if first == 0:
        return None
    return (
        f"tick {first} came first; where another station had begun its run before, "
        f"wait {SILENCE:.0f} s, so that it is given up"
    )


def _repeats(session: LockstepSession) -> str | None:
    """Two more of the same tick, while nobody answers."""
    for _ in range(2):
        came = session.wait_for(Tick, session.waits.react)
        if came is None:
            return f"tick {session.tick} is not repeated"
        if came.tick != session.tick:
            return (
                f"tick {came.tick} came, though nobody answered {session.tick}; "
                "does it have a clock of its own (--pace realtime)?"
            )
    return None


def _repeats_the_same(session: LockstepSession) -> str | None:
    if tick_comes_first(session):
        raise DoesNotApplyError("its measurements come after their tick")
    said: dict[int, tuple[Batch, Tick]] = {}
    for batch, last in batches(session):
        if said.setdefault(last.tick, (batch, last)) != (batch, last):
            return f"tick {last.tick} is repeated with other messages"
    return None


def _one_by_one(session: LockstepSession) -> str | None:
    for _ in range(5):
        session.exchange()
    for before, after in pairwise(session.told(Tick)):
        if after.tick - before.tick not in (0, 1):
            return f"tick {after.tick} follows tick {before.tick}"
    return None


def _incomplete(session: LockstepSession) -> str | None:
    session.send(session.command(session.tick, estimates=1))
    if session.reacts(session.refusal):
        return "a command was taken without the estimate that it tells of"
    session.exchange()
    return None


def _later(session: LockstepSession, _: Forged) -> bytes:
    return session.forged(session.command(session.tick + 1)).raw


def _earlier(session: LockstepSession, _: Forged) -> bytes:
    return session.forged(session.command(max(session.tick - 1, 0))).raw


ITEMS: list[Item[LockstepSession]] = [
    BEGINS,
    Item("lock-step", "its run begins with tick 0", _begins_at_zero),
    Item("lock-step", "an unanswered tick is repeated", _repeats),
    *RECEIVING,
    Item("lock-step", "it goes from tick to tick", _one_by_one),
    Item("lock-step", "a command for a later tick is no answer", refused(_later)),
    Item("lock-step", "a command for an earlier tick is no answer", refused(_earlier)),
    Item("lock-step", "an answer waits for its estimate", _incomplete),
    *NOT_MEANT,
    NOT_FINITE,
    Item("timing", f"it goes on within {SOON} s", reacts_soon),
    SETTINGS,
    RECALLS,
    *PLANS,
    *SERVICES,
    *SIGNING,
    Item("lock-step", "a repeat brings the same messages", _repeats_the_same),
    *STAMPED,
    Item("lock-step", "a later measurement tells of no earlier command", no_earlier),
    *SENDING,
    *ENDS,
    GIVES_UP,
]
GIVING_UP: list[Item[LockstepSession]] = [BEGINS, GIVES_UP]
"""For a robot that has but one run, which END would end."""
READING: list[Item[LockstepSession]] = [BEGINS, *RECEIVING, *ENDS]
"""What hinges on how it reads frames."""
