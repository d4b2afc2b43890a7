"""The gateway's loop on the clock of a real robot: ticks happen when the robot says so."""

import math
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from select import select
from time import monotonic

from laglab_gateway.errors import PlantSilentError, PlantWaitsError
from laglab_gateway.loops.conversation import END_TRIES, Conversation
from laglab_gateway.loops.surroundings import READ_ON, Patience, Served, Surroundings, served
from laglab_gateway.relay import Relay
from laglab_gateway.speakers import from_robot
from laglab_protocol import (
    TELLS_WITHIN,
    EndpointError,
    EndReason,
    Frame,
    Listener,
    Parties,
    Refusals,
    Settings,
    Tick,
    differences,
    refuse_other_sample_time,
    stranger_as_robot,
)

GREETED_AGAIN = 0.3
"""[s] A robot that says nothing for so long may have begun again, and wait to be greeted."""
REPEATED = 4
"""So often no link brings the same tick by itself: a robot says it again."""


class RobotLine:
    """The relay's talk with the robot over one endpoint."""

    def __init__(self, relay: Relay, listener: Listener, patience: Patience) -> None:
        self._relay = relay
        self._link = listener.link
        self._patience = patience
        self._listener = listener
        self._refusals = Refusals(monotonic(), "--plant-key")
        self._heard = self._greeted = monotonic()
        self._repeated = 0
        """How often the newest tick came again."""
        self._stranger: str | None = None
        """Who ticks and is not our robot, until that is told; then empty."""
        self._compared: Settings | None = None
        self._asked: float | None = None
        """When its settings were missed for the first time."""

    @contextmanager
    def run(self) -> Iterator[None]:
        """However the run ends within, the robot is stopped."""
        try:
            yield
        except KeyboardInterrupt:
            self._say_goodbye(EndReason.INTERRUPTED)
            raise
        except BaseException:
            with suppress(EndpointError):
                self._say_goodbye(EndReason.FAILED)
            raise
        self._say_goodbye(EndReason.FAILED)

    def start(self) -> None:
        """The run begins; what the robot said before is forgotten."""
        self._listener.forget()
        self._heard = monotonic()
        self.greet()

    def greet(self) -> None:
        """Make a robot begin that does not tick yet."""
        self._greeted = monotonic()
        self._link.send(self._relay.greeting())

    def greet_if_silent(self) -> None:
        """As long as it does not tick, now and then."""
        if monotonic() - max(self._heard, self._greeted) > GREETED_AGAIN:
            self.greet()

    def ticks(self) -> Iterator[None]:
        """Each tick of the robot that begins with what has arrived."""
        for frame in self._listen(0.0):
            if self._relay.hear_robot(frame):
                self._heard, self._repeated = monotonic(), 0
                yield
            elif isinstance(frame.message, Tick) and frame.message.tick == self._relay.tick:
                self._repeated += 1

    def _listen(self, timeout: float) -> list[Frame]:
        heard = self._listener.listen(timeout)
        if self._stranger is None and not self._relay.under_way:
            self._stranger = stranger_as_robot(heard, self._link.name) or None
        frames = [frame for frame in heard if from_robot(frame)]
        if frames:
            self._link.accept_peer()
        return frames

    @property
    def seems_silent(self) -> bool:
        """Whether the last tick that was read was longer ago than allowed."""
        return monotonic() - self._heard > self._patience.robot_silence

    def check_silence(self) -> None:
        """Raises PlantSilentError when the last tick was longer ago than allowed, PlantWaitsError
        when it was said again and again since."""
        if not self.seems_silent:
            return
        seconds, tick = monotonic() - self._heard, self._relay.tick
        if self._relay.under_way and self._repeated >= REPEATED:
            raise PlantWaitsError(self._link.name, tick, seconds)
        raise PlantSilentError(self._link.name, tick if self._relay.under_way else None, seconds)

    def not_taken(self) -> Iterator[str]:
        """Now and then: whose frames are not taken, or why not, and how to mend that."""
        if self._stranger:  # it may be our robot, under another name
            yield self._stranger
            self._stranger = ""
        yield from self._refusals.news([self._listener], monotonic())

    def compare_settings(self) -> str:
        """What the robot was told differently, as soon as it tells; empty when all is well.
        Raises SettingsError when it ticks at another pace."""
        robot = self._relay.robot_settings
        if robot is None or robot is self._compared:
            return self.missed_settings(TELLS_WITHIN) if robot is None else ""
        self._compared = robot
        told, pace = self._relay.told_robot, robot.sample_time
        parties = Parties(
            f"the robot at {self._link.name}", "this gateway", f"say --set sample_time={pace:g}"
        )
        refuse_other_sample_time(robot, told, parties)
        said = differences(robot, told, parties)
        return f"the robot was told different things: {said}" if said else ""

    def missed_settings(self, patience: float) -> str:
        """That the robot does not tell them: once, so long [s] after the first tick."""
        if self._relay.robot_settings is not None:
            return ""
        now = monotonic()
        self._asked = now if self._asked is None else self._asked
        if now - self._asked < patience:
            return ""
        self._asked = math.inf
        return "the robot does not tell its settings: nothing to compare with ours"

    def forward(self) -> None:
        """Send what the robot is to have now."""
        if frames := self._relay.forward():
            self._link.send(b"".join(frames))

    def _say_goodbye(self, reason: EndReason) -> None:
        """Stop the robot, and give it a few chances to say that it heard."""
        reason = self._relay.stop(reason).reason
        for _ in range(END_TRIES):
            self._link.send(self._relay.end_of_robot(reason))
            if self._relay.robot_end is None:
                self._hear_the_last()
            if self._relay.robot_end is not None:
                return

    def _hear_the_last(self) -> None:
        deadline = monotonic() + self._patience.repeat_after
        while self._relay.robot_end is None and (left := deadline - monotonic()) > 0:
            for frame in self._listen(left):
                self._relay.hear_robot(frame)


def serve_remote(relay: Relay, robot: Listener, around: Surroundings) -> Served:
    """Relay between robot and station to the run's last tick.

    However it ends, both sides are told, the robot first.

    Raises:
        StationSilentError: the station never came, or fell silent.
        PlantSilentError: the robot does not speak our dialect, or fell silent.
        PlantWaitsError: it has no clock of its own.
        SettingsError: one of them ticks at another pace.
        EndpointError: one of the two links broke.
        TraceError: what happened could not be kept.
    """
    station = around.station.link
    line = RobotLine(relay, robot, around.patience)
    conversation = Conversation(relay, around)
    with conversation.run(), line.run():
        conversation.wait_for_station()
        line.start()
        while relay.outcome is None:
            ready, _, _ = select([robot.link, station], [], [], around.patience.repeat_after)
            if station in ready:
                conversation.listen(0.0)
            if robot.link in ready:
                _relay_ticks(relay, line, conversation, around)
            line.greet_if_silent()
            line.forward()
            for said in line.not_taken():
                around.warn(said)
            for _ in range(READ_ON):
                if relay.outcome is None and line.seems_silent:
                    _relay_ticks(relay, line, conversation, around)
            line.check_silence()
        # A robot that refuses our pace says END, and no tick.
        for said in filter(None, (line.compare_settings(), line.missed_settings(0.0))):
            around.warn(said)
    return served(relay)


def _relay_ticks(
    relay: Relay, line: RobotLine, conversation: Conversation, around: Surroundings
) -> None:
    for _ in line.ticks():
        if relay.under_way:
            conversation.finish_tick()
        if said := line.compare_settings():
            around.warn(said)
        if relay.outcome is not None:
            return
        conversation.check_silence()
        conversation.send(relay.open_tick())
        conversation.catch_up()
        conversation.ask_time()
