"""The items of a robot that runs by its own clock and follows the newest command it has heard."""

import time
from functools import partial
from itertools import pairwise

from laglab_conformance.framing import RECEIVING, SENDING, SIGNING
from laglab_conformance.items import Item
from laglab_conformance.robot import (
    BEGINS,
    ENDS,
    NOT_FINITE,
    NOT_MEANT,
    RECALLS,
    SETTINGS,
    STAMPED,
    RobotSession,
    is_after,
    is_tick,
    ticks,
)
from laglab_conformance.services import SERVICES
from laglab_conformance.session import NoReactionError
from laglab_protocol.framing.frame import Frame
from laglab_protocol.messages.loop import Measurement

UNEVEN = 0.25
"""By how much the ticks a second may differ within a few seconds, as a share."""

AT_ONCE = 0.0003
"""[s] What comes sooner was there already."""
MOST_PILED_UP = 1000


class FreeRunningSession(RobotSession):
    """Its station. The stimulus is a command stamped with the newest tick that was heard, the
    reaction a measurement that tells of it, or of a later one, as the command in force."""

    followed = 0
    """The stamp of the last command that it has followed."""

    def is_reaction(self, frame: Frame) -> bool:
        return isinstance(frame.message, Measurement) and frame.message.command_tick >= self.tick

    def go_on(self) -> None:
        """To a later tick: the measurement that told of this one may have come before its own."""
        self.followed = self.tick
        super().go_on()
        if self.tick == self.followed:
            self.listen(self.waits.react, partial(is_after, self.followed))
            super().go_on()

    def exchange(self) -> None:
        """With the newest tick: what was refused may have used up the one before."""
        super().go_on()
        super().exchange()


def _goes_on(session: FreeRunningSession) -> str | None:
    for _ in range(3):
        last = ticks(session)[-1].tick
        if not session.listen(session.waits.react, partial(is_after, last)):
            return f"no tick comes after {last}, though it is to wait for nobody"
    return None


def _even(session: FreeRunningSession) -> str | None:
    session.exchange()
    before, after = _rate(session), _rate(session)
    if abs(before - after) > UNEVEN * max(before, after):
        return f"{before:.0f} ticks a second, then {after:.0f}"
    return None


def _rate(session: FreeRunningSession) -> float:
    """Ticks a second, over half as long as a reaction may take."""
    began, first = _next_tick(session)
    session.send(session.command(first))  # a robot may give up a silent station
    session.listen(session.waits.react / 2, lambda _: False)
    ended, last = _next_tick(session)
    return (last - first) / (ended - began)


def _next_tick(session: FreeRunningSession) -> tuple[float, int]:
    """When the next one came that had to be waited for: what had piled up tells no time."""
    for _ in range(MOST_PILED_UP):
        asked = time.monotonic()
        if session.listen(session.waits.react, is_tick) is None:
            raise NoReactionError("no tick comes any more")
        if time.monotonic() - asked > AT_ONCE:
            break
    return time.monotonic(), ticks(session)[-1].tick


def _earlier(session: FreeRunningSession) -> str | None:
    """Stamped one tick earlier than the newest, and later than all that were sent before that."""
    session.quiet()
    session.exchange()
    earlier = session.followed - 1
    session.send(session.command(earlier))
    if session.listen(session.refusal, partial(_tells_of, earlier)):
        return f"command {earlier} was followed after {session.followed}"
    return None


def _tells_of(stamp: int, frame: Frame) -> bool:
    return isinstance(frame.message, Measurement) and frame.message.command_tick == stamp


def _one_by_one(session: FreeRunningSession) -> str | None:
    for before, after in pairwise(ticks(session)):
        if after.tick != before.tick + 1:
            return f"tick {after.tick} follows tick {before.tick}"
    return None


ITEMS: list[Item[FreeRunningSession]] = [
    BEGINS,
    Item("ticks", "it waits for no answer", _goes_on),
    Item("timing", "its ticks come evenly", _even),
    *RECEIVING,
    Item("ticks", "a command that is older than the newest is not followed", _earlier),
    NOT_MEANT,
    NOT_FINITE,
    SETTINGS,
    RECALLS,
    *SERVICES,
    *SIGNING,
    Item("ticks", "each tick comes once", _one_by_one),
    *STAMPED,
    *SENDING,
    ENDS,
]
