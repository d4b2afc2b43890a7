"""The items of a robot: we are its station. No item makes it move."""

import statistics
import time
from itertools import pairwise

from laglab_protocol.conform.framing import RECEIVING, SENDING, SIGNING
from laglab_protocol.conform.items import Item, refused
from laglab_protocol.conform.session import NoReactionError, Session
from laglab_protocol.frame import Frame
from laglab_protocol.generated import laglab as mavlink
from laglab_protocol.message import Message
from laglab_protocol.messages import (
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    End,
    EndReason,
    Measurement,
    Tick,
)
from laglab_protocol.standard import (
    STATION_HEARTBEAT,
    AutopilotVersion,
    CommandAck,
    CommandLong,
    Heartbeat,
    ParamRequestList,
    ParamRequestRead,
    ParamValue,
    Ping,
)

Batch = list[Measurement]

NO_SUCH_COMMAND = 65_000
SOON = 0.25
"""[s] Within this time, as a median, a robot goes on after an answer."""


class RobotSession(Session):
    """Its station. The stimulus is the command for its tick, the reaction its next tick."""

    system, component = STATION_SYSTEM, STATION_COMPONENT
    peer = (ROBOT_SYSTEM, ROBOT_COMPONENT)
    tick = 0

    def connect(self) -> None:
        deadline = time.monotonic() + self.patience.appear
        while time.monotonic() < deadline:
            self.send(STATION_HEARTBEAT)
            if frame := self.listen(self.patience.refuse, _is_tick):
                assert isinstance(frame.message, Tick)
                self.tick = frame.message.tick
                return
        raise NoReactionError("no LAGLAB_TICK, though a station sent heartbeats")

    def stimulus(self) -> Message:
        return self.command(self.tick)

    def command(self, tick: int, v: float = 0.0, estimates: int = 0) -> Command:
        """Stand still."""
        return Command(v, 0.0, tick, *self.peer, estimates)

    def is_reaction(self, frame: Frame) -> bool:
        return isinstance(frame.message, Tick) and frame.message.tick > self.tick

    def go_on(self) -> None:
        ticks = [frame.message.tick for frame in self.heard if isinstance(frame.message, Tick)]
        self.tick = max(ticks)

    def ask(self, question: Message, answer: type[Message], seconds: float | None = None) -> Frame:
        """The first answer of this kind. Raises NoReactionError."""
        self.send(question)
        patience = self.patience.react if seconds is None else seconds
        found = self.listen(patience, lambda frame: isinstance(frame.message, answer))
        if found is None:
            raise NoReactionError(f"no {answer.__name__} after {type(question).__name__}")
        return found

    def order(self, number: int, first: float = 0.0) -> CommandAck:
        """A command (MAV_CMD) and its acknowledgement."""
        long = CommandLong(first, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, number, *self.peer, 0)
        ack = self.ask(long, CommandAck).message
        assert isinstance(ack, CommandAck)
        if ack.command != number:
            raise NoReactionError(f"command {number} acknowledged as {ack.command}")
        return ack


def _is_tick(frame: Frame) -> bool:
    return isinstance(frame.message, Tick)


def _ticks(session: RobotSession) -> list[Tick]:
    return [frame.message for frame in session.heard if isinstance(frame.message, Tick)]


# Lock-step


def _begins(session: RobotSession) -> str | None:
    session.connect()
    return None


def _repeats(session: RobotSession) -> str | None:
    """Two more of the same, while nobody answers; each whole."""
    for _ in range(2):
        frame = session.listen(session.patience.react, _is_tick)
        if frame is None:
            return f"tick {session.tick} is not repeated"
        assert isinstance(frame.message, Tick)
        if frame.message.tick != session.tick:
            return f"tick {frame.message.tick} came, though nobody answered {session.tick}"
    return None


def _repeats_the_same(session: RobotSession) -> str | None:
    said: dict[int, tuple[Batch, Tick]] = {}
    for batch, last in _batches(session):
        if said.setdefault(last.tick, (batch, last)) != (batch, last):
            return f"tick {last.tick} is repeated with other messages"
    return None


def _batches(session: RobotSession) -> list[tuple[Batch, Tick]]:
    """Every tick with the measurements that came since the one before."""
    batches, waiting = [], Batch()
    for frame in session.heard:
        if isinstance(frame.message, Measurement):
            waiting.append(frame.message)
        elif isinstance(frame.message, Tick):
            batches.append((waiting, frame.message))
            waiting = Batch()
    return batches


def _counts(session: RobotSession) -> str | None:
    for batch, last in _batches(session):
        if len(batch) != last.measurements:
            return f"{last} came after {len(batch)} measurements"
    return None


def _one_by_one(session: RobotSession) -> str | None:
    for _ in range(5):
        session.exchange()
    for before, after in pairwise(_ticks(session)):
        if after.tick - before.tick not in (0, 1):
            return f"tick {after.tick} follows tick {before.tick}"
    return None


def _echoes(session: RobotSession) -> str | None:
    """Each measurement names an earlier command, later ones no earlier command; none moves."""
    found = {frame.message for frame in session.heard if isinstance(frame.message, Measurement)}
    latest = NO_COMMAND
    for each in sorted(found, key=lambda measurement: measurement.tick):
        if not latest <= each.command_tick < max(each.tick, 0):
            return f"the measurement of tick {each.tick} names command {each.command_tick}"
        if (each.v, each.omega) != (0.0, 0.0):
            return f"the measurement of tick {each.tick} moves, though nobody commanded it"
        latest = each.command_tick
    return None


def _not_finite(session: RobotSession) -> str | None:
    """Taken or not, it must never be in force, and the robot must go on."""
    session.send(session.command(session.tick, v=float("nan")))
    if not session.reacts(session.patience.refuse):
        session.exchange()
    return None


def _incomplete(session: RobotSession) -> str | None:
    session.send(session.command(session.tick, estimates=1))
    if session.reacts(session.patience.refuse):
        return "a command was taken without the estimate that it tells of"
    session.exchange()
    return None


def _ends(session: RobotSession) -> str | None:
    """It answers END with the same reason."""
    end = End(session.tick, EndReason.INTERRUPTED)
    session.send(end)
    answer = session.listen(session.patience.react, lambda frame: isinstance(frame.message, End))
    if answer is None:
        return "END is not answered"
    assert isinstance(answer.message, End)
    if answer.message.reason != end.reason:
        return f"END with reason {end.reason} is answered with {answer.message.reason}"
    return None


def _soon(session: RobotSession) -> str | None:
    times = []
    for _ in range(9):
        started = time.monotonic()
        session.exchange()
        times.append(time.monotonic() - started)
    median = statistics.median(times)
    return f"median {median:.3f} s" if median > SOON else None


# Services


def _reports(number: int, kind: type[Message]) -> Item[RobotSession]:
    def check(session: RobotSession) -> str | None:
        before = len(session.heard)
        ack = session.order(mavlink.MAV_CMD_REQUEST_MESSAGE, float(number))
        if ack.result != mavlink.MAV_RESULT_ACCEPTED:
            return f"refused with MAV_RESULT {ack.result}"
        if any(isinstance(frame.message, kind) for frame in session.heard[before:]):
            return None  # it came together with the acknowledgement
        if session.listen(session.patience.react, lambda frame: isinstance(frame.message, kind)):
            return None
        return f"accepted, but no {kind.__name__} came"

    return Item("services", f"it reports {kind.__name__} on request", check, mandatory=False)


def _acknowledges(session: RobotSession) -> str | None:
    ack = session.order(NO_SUCH_COMMAND)
    expected = mavlink.MAV_RESULT_UNSUPPORTED
    return None if ack.result == expected else f"answered with MAV_RESULT {ack.result}"


def _lists_parameters(session: RobotSession) -> str | None:
    first = session.ask(ParamRequestList(*session.peer), ParamValue).message
    assert isinstance(first, ParamValue)
    session.quiet()
    values = {
        frame.message.param_index: frame.message
        for frame in session.heard
        if isinstance(frame.message, ParamValue)
    }
    missing = set(range(first.param_count)) - set(values)
    return f"{len(missing)} of {first.param_count} did not come" if missing else None


def _reads_parameters(session: RobotSession) -> str | None:
    by_index = session.ask(ParamRequestRead(0, *session.peer, b""), ParamValue).message
    assert isinstance(by_index, ParamValue)
    named = ParamRequestRead(-1, *session.peer, by_index.param_id)
    by_name = session.ask(named, ParamValue).message
    return None if by_name == by_index else f"{by_index} by index, {by_name} by name"


def _answers_ping(session: RobotSession) -> str | None:
    session.send(Ping(123, 7, 0, 0))
    answer = Ping(123, 7, session.system, session.component)
    found = session.listen(session.patience.react, lambda frame: frame.message == answer)
    return None if found else "no answer"


ITEMS: list[Item[RobotSession]] = [
    Item("lock-step", "it begins when a station is heard", _begins),
    Item("lock-step", "an unanswered tick is repeated", _repeats),
    *RECEIVING,
    Item("lock-step", "it goes from tick to tick", _one_by_one),
    Item(
        "lock-step",
        "a command for a later tick is no answer",
        refused(lambda session, _: session.forged(_at(session, +1)).raw),
    ),
    Item(
        "lock-step",
        "a command for an earlier tick is no answer",
        refused(lambda session, _: session.forged(_at(session, -1)).raw),
    ),
    Item("lock-step", "an answer waits for its estimate", _incomplete),
    Item("lock-step", "it survives a command that is not finite", _not_finite),
    Item("timing", f"it goes on within {SOON} s", _soon),
    Item("services", "an unknown command is acknowledged as such", _acknowledges),
    _reports(mavlink.MAVLINK_MSG_ID_HEARTBEAT, Heartbeat),
    _reports(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION, AutopilotVersion),
    Item("services", "it lists its parameters", _lists_parameters, mandatory=False),
    Item("services", "it reads a parameter by index and name", _reads_parameters, mandatory=False),
    Item("services", "it answers a ping", _answers_ping, mandatory=False),
    *SIGNING,
    Item("lock-step", "the tick counts its measurements", _counts),
    Item("lock-step", "a repeat brings the same messages", _repeats_the_same),
    Item("lock-step", "measurements tell the command in force", _echoes),
    *SENDING,
    Item("lock-step", "it answers END", _ends),
]


def _at(session: Session, offset: int) -> Command:
    assert isinstance(session, RobotSession)
    return session.command(max(session.tick + offset, 0))
