"""What the kit does with any robot: we are its station, and no item drives it faster than CREEP."""

import math
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from msgspec.structs import replace

from laglab_conformance.forge import Forged
from laglab_conformance.items import Item, refused, wrongly_told
from laglab_conformance.session import DoesNotApplyError, M, NoReactionError, Session, Waits
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Applied,
    Command,
    CommandAck,
    CommandLong,
    Endpoint,
    Frame,
    Measurement,
    Message,
    Recall,
    Settings,
    Tick,
)

Batch = list[Measurement | Applied]

ANOTHER, EVERYBODY = 7, 0
"""Systems that are not, or not by name, the robot under test."""

CREEP = 1e-6
"""[m/s] Nobody sees it, and yet measurements tell it from a standstill."""
ROUNDED = 1e-3
"""What of a speed may get lost in a robot, as a share: many count in single precision."""


class RobotSession(Session):
    """The robot's station. The stimulus is the command for its tick."""

    system, component = STATION_SYSTEM, STATION_COMPONENT
    peer = (ROBOT_SYSTEM, ROBOT_COMPONENT)
    longest_delay = 0
    """Within so many exchanges after the one that took a command, a measurement tells of it."""
    plans = False
    """Whether it was seen to go on by a plan."""
    silent = False
    """Whether it is to hear nothing from us."""

    def __init__(self, endpoint: Endpoint, waits: Waits, key_file: Path | None) -> None:
        super().__init__(endpoint, waits, key_file)
        self.said: set[int] = set()
        """The stamps of all commands that were sent."""

    def connect(self) -> None:
        self.meet(self.waits.appear)

    def meet(self, seconds: float) -> None:
        """Greet it until it ticks. Raises NoReactionError when it does not within `seconds`."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            self.send(STATION_HEARTBEAT)
            if begun := self.wait_for(Tick, self.waits.refuse):
                self.tick = begun.tick
                return
        raise NoReactionError("no LAGLAB_TICK, though a station sent heartbeats")

    def stimulus(self) -> Message:
        return self.command(self.tick)

    def forged(self, message: Message | None = None) -> Forged:
        message = self.stimulus() if message is None else message
        if isinstance(message, Command):
            self.said.add(message.tick)
        return super().forged(message)

    def command(self, tick: int, v: float = 0.0, estimates: int = 0, plan: int = 0) -> Command:
        """A command for `tick`; by default, to stand still."""
        return Command(v, 0.0, tick, *self.peer, estimates, plan)

    def watch(self, until: Callable[[Frame], bool], seconds: float) -> Frame | None:
        """As `listen`, while nothing is commanded that is meant for now."""
        return self.listen(seconds, until)

    def go_on(self) -> None:
        self.tick = max(each.tick for each in self.told(Tick))

    def ask(self, question: Message, kind: type[M]) -> M:
        """The first answer of this kind. Raises NoReactionError."""
        self.send(question)
        answer = self.wait_for(kind, self.waits.react)
        if answer is None:
            raise NoReactionError(f"no {kind.__name__} after {type(question).__name__}")
        return answer

    def order(self, number: int, first: float = 0.0) -> CommandAck:
        """The acknowledgement of a command (MAV_CMD). Raises NoReactionError."""
        long = CommandLong(first, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, number, *self.peer, 0)
        ack = self.ask(long, CommandAck)
        if ack.command != number:
            raise NoReactionError(f"command {number} acknowledged as {ack.command}")
        return ack


def is_after(tick: int, frame: Frame) -> bool:
    return isinstance(frame.message, Tick) and frame.message.tick > tick


def newest_measurement(session: RobotSession) -> Measurement:
    """Raises NoReactionError: none ever came."""
    told = measurements(session)
    if not told:
        raise NoReactionError("no measurement came")
    return told[-1]


def measurements(session: RobotSession) -> list[Measurement]:
    """All that came, by the ticks at which they were sampled."""
    return sorted(session.told(Measurement), key=lambda measurement: measurement.tick)


def batches(session: RobotSession) -> list[tuple[Batch, Tick]]:
    """Every tick but the first, which we may have heard in part, with its measurements."""
    whole, waiting = [], Batch()
    for frame in session.heard:
        if isinstance(frame.message, Measurement | Applied):
            waiting.append(frame.message)
        elif isinstance(frame.message, Tick):
            whole.append((waiting, frame.message))
            waiting = Batch()
    return whole[1:]


def creep(session: RobotSession) -> Measurement | None:
    """Creep, by a command with the session's tick; the first measurement that tells of that, or
    None when none does, as where the robot drives at no speed so low. Raises NoReactionError."""
    before = len(session.heard)
    session.send(session.command(session.tick, v=CREEP))
    if not session.reacts(session.waits.react):
        raise NoReactionError(f"no reaction to a command of {CREEP} m/s at tick {session.tick}")
    for _ in range(session.longest_delay):
        if any(map(creeps, session.heard[before:])):
            break
        session.exchange()
    return next(filter(_is_creeping, session.told(Measurement, before)), None)


def creeps(frame: Frame) -> bool:
    """Whether it tells that the robot creeps, as far as the robot can count."""
    return isinstance(frame.message, Measurement) and _is_creeping(frame.message)


def _is_creeping(told: Measurement) -> bool:
    return math.isclose(told.v, CREEP, rel_tol=ROUNDED)


def _begins(session: RobotSession) -> str | None:
    session.connect()
    return None


def _not_finite(session: RobotSession) -> str | None:
    """Taken or not, it must never be in force, and the robot must go on."""
    session.send(session.command(session.tick, v=float("nan")))
    if not session.reacts(session.refusal):
        session.exchange()
    return None


def _meant_for(system: int, session: RobotSession, _: Forged) -> bytes:
    other = replace(session.command(session.tick), target_system=system)
    return session.forged(other).raw


def _settings(session: RobotSession) -> str | None:
    """It answers LAGLAB_SETTINGS with its own."""
    return wrongly_told(session.ask(Settings(math.nan), Settings))


def _recalls(session: RobotSession) -> str | None:
    """The speeds in force just before the newest measurement must be those that it told."""
    session.exchange()
    newest = newest_measurement(session)
    if newest.tick == 0:
        raise DoesNotApplyError("nothing was in force before its first tick")
    asked, before = Recall(newest.tick - 1, 1, *session.peer), len(session.heard)
    deadline = time.monotonic() + 2 * session.waits.react
    while time.monotonic() < deadline:
        session.send(asked, session.command(session.tick, estimates=1))  # it counts the question
        session.reacts(session.waits.react)
        if told := session.told(Applied, before):
            return _as_asked(told[0], asked, newest)
    return "LAGLAB_RECALL is not answered"


def _as_asked(told: Applied, asked: Recall, newest: Measurement) -> str | None:
    if (told.first, told.count) != (asked.first, asked.count):
        return f"asked of tick {asked.first} it tells of {told.count} from {told.first} on"
    right = (told.v[0], told.omega[0]) == newest.speeds
    return None if right else f"{told.v[0]}, {told.omega[0]} instead of {newest.speeds}"


BEGINS = Item("ticks", "it begins when a station is heard", _begins)
NOT_FINITE = Item("ticks", "it survives a command that is not finite", _not_finite)
NOT_MEANT = [
    Item(
        "ticks",
        "a command for another robot is not followed",
        refused(partial(_meant_for, ANOTHER)),
    ),
    Item(
        "ticks",
        "a command for no robot by name is not followed",
        refused(partial(_meant_for, EVERYBODY)),
    ),
]
RECALLS = Item("ticks", "it recalls what was in force", _recalls, mandatory=False)
SETTINGS = Item("ticks", "it tells its settings", _settings, mandatory=False)
