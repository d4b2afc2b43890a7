"""The items on how a robot's run ends: by a word, or by silence."""

import time

from laglab_conformance.items import Item
from laglab_conformance.robot import RobotSession
from laglab_conformance.session import DoesNotApplyError, NoReactionError
from laglab_protocol import End, EndReason, Tick

SILENCE = 3.0
"""[s] After so much of it a robot in lock-step gives its station up."""


def _answers(session: RobotSession) -> str | None:
    """With the same reason, and then no more ticks."""
    end, before = End(session.tick, EndReason.INTERRUPTED), len(session.heard)
    session.send(end)
    session.over = True
    answer = session.wait_for(End, session.waits.react)
    if answer is None:
        return "END is not answered"
    if answer.reason != end.reason:
        return f"END with reason {end.reason} is answered with {answer.reason}"
    session.quiet()
    return "it goes on after END" if session.goes_on(Tick, before) else None


def _ends(session: RobotSession) -> list[End]:
    """Every END that came. Raises DoesNotApplyError when none did."""
    ends = session.told(End)
    if not ends:
        raise DoesNotApplyError("END is not answered")
    return ends


def _once(session: RobotSession) -> str | None:
    count = len(_ends(session))
    return f"it said END {count} times" if count > 1 else None


def _at_its_tick(session: RobotSession) -> str | None:
    """Not before the tick that our END named, which the robot had begun."""
    wrong = [each.tick for each in _ends(session) if each.tick < session.tick]
    return f"END at tick {session.tick} is answered with tick {wrong[0]}" if wrong else None


def _gives_up(session: RobotSession) -> str | None:
    """In another run, as END has ended the first."""
    try:
        session.meet(session.waits.react)
    except NoReactionError as error:
        raise DoesNotApplyError(
            "its run is over and no heartbeat begins another: start it again, and say --silent"
        ) from error
    began, session.silent = time.monotonic(), True
    while session.wait_for(Tick, session.waits.react / 2):
        silent = time.monotonic() - began
        if silent > SILENCE + session.waits.react:
            return f"it still repeats its tick after {silent:.0f} s of silence"
    return None


ENDS = [
    Item("ticks", "it answers END", _answers),
    Item("ticks", "it says END once", _once),
    Item("ticks", "its END names its last tick", _at_its_tick),
]
GIVES_UP = Item("lock-step", "it gives up a silent station", _gives_up)
