"""The items of a controller: we are its robot, and stand at the origin."""

import math
from typing import TypeAlias

from laglab_conformance.framing import RECEIVING, SENDING, SIGNING
from laglab_conformance.items import SOON, Item, reacts_soon, refused, wrongly_told
from laglab_conformance.session import DoesNotApplyError, NoReactionError, Session
from laglab_protocol import (
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Assembly,
    Command,
    End,
    EndReason,
    Estimate,
    Frame,
    Heartbeat,
    Measurement,
    Message,
    Plan,
    Recall,
    Settings,
    Tick,
)

Said: TypeAlias = Estimate | Recall | Plan | Command
"""What an answer is made of."""


class ControllerSession(Session):
    """The controller's robot. The stimulus is the next tick, the reaction the command for it."""

    system, component = ROBOT_SYSTEM, ROBOT_COMPONENT
    peer = (STATION_SYSTEM, STATION_COMPONENT)

    def connect(self) -> None:
        if self.wait_for(Heartbeat, self.waits.appear) is None:
            raise NoReactionError("no HEARTBEAT came")

    def stimulus(self) -> Message:
        return Tick(self.tick, 0)

    def is_reaction(self, frame: Frame) -> bool:
        return isinstance(frame.message, Command) and frame.message.tick == self.tick

    def go_on(self) -> None:
        self.tick += 1

    def answer_to(self, *messages: Message) -> list[Said]:
        """What came back, up to the command, for one datagram of these. Raises NoReactionError."""
        before = len(self.heard)
        self.send(*messages)
        if self.wait_for(Command, self.waits.react):
            came = (frame.message for frame in self.heard[before:])
            said = [message for message in came if isinstance(message, Said)]
            commands = (i for i, message in enumerate(said) if isinstance(message, Command))
            return said[: next(commands) + 1]
        raise NoReactionError(f"no answer to {messages[-1]}")


def _sample(tick: int) -> Measurement:
    return Measurement(0.0, 0.0, 0.0, 0.0, 0.0, tick, NO_COMMAND)


def _calls(session: ControllerSession) -> str | None:
    session.connect()
    session.exchange()
    return None


def _answers_whole(session: ControllerSession) -> str | None:
    """At most one estimate, then the command that tells of it, all stamped with the tick."""
    for _ in range(5):
        tick = session.tick
        *estimates, command = session.answer_to(_sample(tick), Tick(tick, 1))
        session.go_on()
        assert isinstance(command, Command)
        if command.tick != tick or any(_stamp(each, tick) != tick for each in estimates):
            return f"tick {tick} is answered with other stamps: {command}"
        came = sum(not isinstance(each, Plan) for each in estimates)
        if command.estimates != came:
            return f"the command tells of {command.estimates} estimates, {came} came"
    return None


def _stamp(message: Said, tick: int) -> int:
    return tick if isinstance(message, Recall) else message.tick


def _aims(session: ControllerSession) -> str | None:
    us = session.system, session.component
    for command in session.told(Command):
        target = command.target_system, command.target_component
        if target != us:
            return f"a command is meant for {target}, the robot is {us}"
    return None


def _finite(session: ControllerSession) -> str | None:
    for told in session.told(Command):
        if not all(map(math.isfinite, told.speeds)):
            return f"{told}"
    for plan in session.told(Plan):
        if not all(map(math.isfinite, plan.v + plan.omega)):
            return f"{plan}"
    return None


def _plans_whole(session: ControllerSession) -> str | None:
    """All of what a command plans comes before it, and is meant for its tick or later."""
    answers = 0
    for _ in range(3):
        *before, command = session.answer_to(_sample(session.tick), Tick(session.tick, 1))
        session.go_on()
        assert isinstance(command, Command)
        assembly = Assembly()
        for message in before:
            if isinstance(message, Plan):
                assembly.take(message)
        whole = assembly.take(command)
        if whole is None:
            return f"of the plan of command {command.tick} not all comes before it"
        if whole.in_force is not None and whole.in_force < command.tick:
            return f"command {command.tick} is planned for tick {whole.in_force}, which is past"
        answers += command.plan > 0
    if not answers:
        raise DoesNotApplyError("its commands have no plans")
    return None


def _answers_again(session: ControllerSession) -> str | None:
    """Twice the same tick, with its measurement: the same answer."""
    tick, batch = session.tick, (_sample(session.tick), Tick(session.tick, 1))
    first = session.answer_to(*batch)
    again = session.answer_to(*batch)
    session.go_on()
    return None if again == first else f"tick {tick} is answered with {first}, then with {again}"


def _answers_once(session: ControllerSession) -> str | None:
    tick = session.tick
    session.exchange()
    session.quiet()
    count = sum(answer.tick == tick for answer in session.told(Command))
    return None if count == 1 else f"tick {tick} is answered {count} times"


def _missing(session: ControllerSession, _: object) -> bytes:
    """A tick that tells of a measurement that did not arrive."""
    return session.forged(Tick(session.tick, 1)).raw


def _backwards(session: ControllerSession) -> str | None:
    """A tick from before the last one."""
    session.exchange()
    session.exchange()
    old = session.tick - 2
    session.send(Tick(old, 0))
    found = session.listen(
        session.refusal,
        lambda frame: isinstance(frame.message, Command) and frame.message.tick == old,
    )
    if found:
        return f"tick {old} is answered, though tick {old + 1} was"
    session.exchange()
    return None


def _ends(session: ControllerSession) -> str | None:
    """It answers END once with the same, and says nothing of an end before, nor commands after."""
    early, before = session.ended, len(session.heard)
    end = End(session.tick - 1, EndReason.COMPLETED)
    session.send(end)
    session.wait_for(End, session.waits.react)
    session.quiet()
    answers = session.told(End, before)
    if early:
        return f"it said {early}, and nobody had ended its run"
    if len(answers) != 1:
        return f"answered {len(answers)} times"
    if session.goes_on(Command, before):
        return "it goes on after END"
    return None if answers[0] == end else f"{end} is answered with {answers[0]}"


def _asks(session: ControllerSession) -> str | None:
    """Of a few ticks no measurement comes, nor what it would have told of the command in force."""
    for missed in (False, True, True, True, *[False] * 30):
        tick, before = session.tick, len(session.heard)
        session.answer_to(*([] if missed else [_sample(tick)]), Tick(tick, int(not missed)))
        session.go_on()
        if session.told(Recall, before):
            return None
    return "it does not ask what was in force at ticks of which it heard nothing"


def _tells_settings(session: ControllerSession) -> str | None:
    told = session.told(Settings)
    return wrongly_told(told[0]) if told else "it calls without LAGLAB_SETTINGS"


ITEMS: list[Item[ControllerSession]] = [
    Item("lock-step", "it calls until the robot is heard", _calls),
    *RECEIVING,
    Item("lock-step", "an answer is whole and stamped", _answers_whole),
    Item("lock-step", "a repeated tick gets the same answer", _answers_again),
    Item("lock-step", "a tick is answered once", _answers_once),
    Item("lock-step", "a tick whose measurement is missing gets no answer", refused(_missing)),
    Item("lock-step", "time does not go back", _backwards),
    Item("lock-step", "commands are meant for the robot", _aims),
    Item("lock-step", "commands are finite", _finite),
    Item("lock-step", "a plan is whole and not past", _plans_whole),
    Item("lock-step", "it tells its settings", _tells_settings, mandatory=False),
    Item("lock-step", "it asks for what it missed", _asks, mandatory=False),
    Item("timing", f"it answers within {SOON} s", reacts_soon),
    *SIGNING,
    *SENDING,
    Item("lock-step", "it answers END once", _ends),
]
