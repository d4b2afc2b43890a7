"""The items on plans: a robot goes on by one, and follows none that lacks a part."""

from laglab_conformance.items import Item
from laglab_conformance.robot import CREEP, RobotSession, creep, creeps, newest_measurement
from laglab_conformance.session import DoesNotApplyError, NoReactionError
from laglab_protocol import Planned

LENGTH = 100
"""Ticks of our plans, in several frames."""


def _reads_off(session: RobotSession) -> str | None:
    """A command to stand still, with a plan to creep after it."""
    session.exchange()
    stamp, creeping = session.tick, ((CREEP, 0.0),) * LENGTH
    plan = Planned(session.command(stamp, plan=LENGTH), stamp, creeping)
    session.send(*plan.frames(), plan.command)
    told = session.watch(creeps, session.waits.react)
    session.plans = told is not None
    _stand(session)
    if told is None and creep(session) is None:
        raise DoesNotApplyError(f"{CREEP} m/s it does not drive")
    session.exchange()
    return None if told else f"of command {stamp} nothing came into force but its first entry"


def _stand(session: RobotSession) -> None:
    """Until its measurements tell that it stands: behind a delay they go on telling of the plan."""
    session.exchange()
    for _ in range(session.longest_delay):
        if newest_measurement(session).v == 0.0:
            break
        session.exchange()


def _whole_or_not(session: RobotSession) -> str | None:
    """A command to creep, of whose plan the last frame never comes."""
    if not session.plans:
        raise DoesNotApplyError("it has no plans")
    session.exchange()
    stamp, creeping = session.tick, ((CREEP, 0.0),) * LENGTH
    command = session.command(stamp, v=CREEP, plan=LENGTH)
    *frames, _ = Planned(command, stamp, creeping).frames()
    session.send(*frames, command)
    try:
        told = session.watch(creeps, session.refusal)
    except NoReactionError:  # it waits for the repeat that brings all
        told = None
    _stand(session)
    return f"command {stamp} is followed, of whose plan a frame is missing" if told else None


PLANS = [
    Item("ticks", "it goes on by the plan of a command", _reads_off, mandatory=False),
    Item("ticks", "what lacks a part of its plan is not followed", _whole_or_not),
]
