"""The robot's side as its station meets it, whatever it is that moves. No clock, no I/O.

Frames in, frames out; the two channels of the link with their audit; which command is followed.
What moves comes in two kinds: a plant that is stepped (`core`), and a robot with a clock of its
own (`relay`).
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence

from laglab_gateway.answer import Answer
from laglab_gateway.config import GatewayConfig
from laglab_gateway.drive import Drive, Rejection, Safety, follow_plan, rejection
from laglab_gateway.incoming import Came, Incoming
from laglab_gateway.link.channel import Channel
from laglab_gateway.link.fates import FateKind, Fates
from laglab_gateway.link.log import LinkRow
from laglab_gateway.link.timeline import Direction
from laglab_gateway.memory import Owed, SpeedMemory
from laglab_gateway.outcome import Outcome, reason_of
from laglab_gateway.record.audit import Audit, DirectionAudit
from laglab_gateway.record.lateness import Lateness
from laglab_gateway.record.rows import Notes
from laglab_gateway.record.trace import TraceRow
from laglab_gateway.services import Asker, RobotState, Services, safety_now
from laglab_gateway.speakers import from_station, is_for_robot
from laglab_gateway.stopping import Stopping
from laglab_protocol import (
    MAV_SEVERITY_EMERGENCY,
    MAV_SEVERITY_ERROR,
    MAV_SEVERITY_WARNING,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Applied,
    Command,
    End,
    EndReason,
    Estimate,
    Frame,
    Heartbeat,
    Measurement,
    Message,
    Plan,
    Planned,
    Recall,
    Sender,
    Settings,
    Statustext,
    Tick,
)

Number = float | None

EMERGENCY_STOP = "emergency stop: the robot stands still"


class RobotSide(ABC):
    """One end of a link that is late, and perhaps worse."""

    def __init__(
        self,
        config: GatewayConfig,
        services: Services,
        fates: Mapping[Direction, Fates] | None = None,
        sender: Sender | None = None,
    ) -> None:
        n, m, Ts = config.command_delay, config.measurement_delay, config.sample_time
        self.first = 0
        """The run's first tick."""
        self.tick = 0
        self.connected = False
        self.outcome: Outcome | None = None
        self.station_end: End | None = None
        self.station_settings: Settings | None = None
        self.audit = Audit(DirectionAudit(n), DirectionAudit(m))
        self.notes = Notes(Ts)
        self.lateness: Lateness | None = None
        """Of its ticks, where the wall clock paces them."""
        self.services = services
        self.settings = config.settings
        self._config = config
        self._sender = sender or Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
        self._notices: list[Statustext] = []
        fates = fates or {}
        self._commands = Incoming(
            Channel("command", n, Ts, fates.get("command")), config.command_playout
        )
        self._measurements: Channel[Measurement | Applied] = Channel(
            "measurement", m, Ts, fates.get("measurement")
        )
        self._answer = Answer()
        self._memory = SpeedMemory()
        self._owed = Owed()
        self._drive = Drive()
        self._stopping = Stopping()
        self._go_to(0)

    def _go_to(self, tick: int) -> None:
        """At this tick nothing was said yet."""
        self.tick = tick
        self._batch: list[Message] = []
        self._answer.begin()

    @property
    def elapsed(self) -> int:
        """Ticks since the run's first: the link's delays and its timeline go by them."""
        return self.tick - self.first

    @property
    def time_us(self) -> int:
        """Time of this tick since the run's first [µs]."""
        return round(self.elapsed * self._config.sample_time * 1e6)

    @property
    @abstractmethod
    def state(self) -> RobotState:
        """The robot at this tick, for those who ask."""

    @property
    def answered(self) -> bool:
        """Whether the station has said all it has to say on this tick."""
        return self._answer.command is not None

    @abstractmethod
    def open_tick(self) -> list[bytes]:
        """The frames that begin this tick for the station."""

    def _tell(self, samples: Iterable[Measurement]) -> list[bytes]:
        """Put samples on the link, and some of what the station asked to be told; the frames: all
        that has come across, and the tick."""
        bound = self._config.measurement_playout
        for sample in samples:
            until = sample.tick - self.first + bound if bound else math.inf
            self._measurements.push(self.elapsed, sample, until)
        for told in self._owed.take():
            self._measurements.push(self.elapsed, told)
        due = self._measurements.due(self.elapsed)
        for message in due:
            if isinstance(message, Measurement):
                self.audit.measurement.arrived(message.tick, self.tick)
                self.notes.came("measurement", message.tick, self.tick, self.elapsed)
        self._batch = [*due, Tick(self.tick, len(due))]
        return self.repeat_tick()

    def repeat_tick(self) -> list[bytes]:
        """The same messages in new frames: the station may have missed the first."""
        return [self._sender.frame(message) for message in self._batch]

    def hear(self, frames: Sequence[Frame], asker: Asker | None = None) -> list[bytes]:
        """Take frames from the link; returns what to say to whoever sent them, the asker."""
        replies: list[Message] = []
        for frame in frames:
            if not from_station(frame) or not self._take(frame.message):
                replies += self._answers(frame, asker)
        return [self._sender.frame(message) for message in replies]

    def _take(self, message: Message) -> bool:
        """Take what belongs to the loop; False when it does not, or asks for a reply."""
        match message:
            case Heartbeat():
                self.connected = True
            case Command() | Recall() | Plan() if not is_for_robot(message):
                pass  # for another robot on the same line
            case Estimate() | Recall() | Plan() | Command():
                if said := self._answer.take(message, self.tick):
                    self._commands.push(self.elapsed, *said)
            case Statustext():
                if not self.answered:  # said again with a repeated answer, it is told once
                    self.announce(message.text.decode(errors="replace"))
            case End():
                self._take_end(message)
            case _:
                return False
        return True

    def _take_end(self, end: End) -> None:
        """An END of a past run, or of a tick that has not come, ends nothing."""
        begun = bool(self._batch)
        if self.outcome or (begun and self._answer.through <= end.tick <= self.tick):
            self.station_end = end

    def _answers(self, frame: Frame, asker: Asker | None) -> list[Message]:
        if from_station(frame) and isinstance(frame.message, Settings):
            self.station_settings = frame.message
            return [self.settings]
        return self.services.answer(frame, self.state, asker)

    def _take_commands(self, tick: int) -> Came:
        """What has come across the link by `tick`; what cannot be followed any more is counted."""
        came = self._commands.take(tick)
        for late in came.late:
            self._refuse(late.command, tick, Rejection.LATE)
        for command in came.incomplete:
            self._refuse(command, tick, Rejection.INCOMPLETE)
        return came

    def _refuse(self, command: Command, tick: int, why: Rejection) -> None:
        self.audit.refused[why] += 1
        self.notes.came("command", command.tick, tick, tick - self.first, why.value)

    def _follow(self, planned: Planned, tick: int, safety: Safety) -> bool:
        """Follow from `tick` on a command that came across; False, and counted, when rejected."""
        if rejected := rejection(self._drive, planned.command, safety, planned.following):
            self._refuse(planned.command, tick, rejected)
            self._stopping.refused(rejected)
            return False
        self._drive = follow_plan(planned, tick)
        self._stopping.followed()
        return True

    def _say_why_stopping(self, silent: int, safety: Safety) -> None:
        """After so many ticks for which nothing has come into force."""
        is_silent = silent * self._config.sample_time >= safety.link_timeout
        if is_silent and (why := self._stopping.news()):
            self.announce(why, MAV_SEVERITY_ERROR)

    @property
    def safety(self) -> Safety:
        """The limits and times now: ground stations may set some of them."""
        return safety_now(self.services.parameters, self._config.safety.ramp)

    def _armed(self, v: float, omega: float) -> tuple[float, float]:
        """These speeds, or standstill while the robot is disarmed."""
        return (v, omega) if self.services.arming.armed else (0.0, 0.0)

    def announce(self, text: str, severity: int = MAV_SEVERITY_WARNING) -> None:
        """Warn everybody who listens, in at most 50 characters, at the end of this tick."""
        self._notices.append(Statustext(severity, text.encode()[:50]))

    def take_notices(self) -> list[Statustext]:
        """What the robot did by itself since the last call: everybody is to be told."""
        notices, self._notices = self._notices, []
        return notices

    def framed(self, messages: Iterable[Message]) -> list[bytes]:
        """The robot's frames of these."""
        return [self._sender.frame(message) for message in messages]

    def ask_time(self) -> list[bytes]:
        """The question how far the station's clock is away, if there is a clock to compare with."""
        timesync = self.services.timesync
        return [self._sender.frame(timesync.ask())] if timesync else []

    def take_link_rows(self) -> list[LinkRow]:
        """What the link did to the frames that entered it since the last call."""
        rows = self._measurements.take_log() + self._commands.take_log()
        for row in rows:
            self.audit.of(row.direction).fates[FateKind(row.fate)] += 1
        return rows

    @abstractmethod
    def close_tick(self) -> TraceRow:
        """Say what happened at this tick, and whether the run ends with it (`outcome`)."""

    @property
    def _ending(self) -> Outcome | None:
        """How the run ends at this tick; None when it goes on."""
        if self.station_end is not None:
            return Outcome(reason_of(self.station_end), self.tick)
        last = self._config.last_tick
        if last is not None and self.elapsed >= last:
            return Outcome(EndReason.COMPLETED, self.tick)
        return None

    def _close(self) -> None:
        self.audit.unanswered += not self.answered
        if self._answer.estimates:
            self.notes.said(self._answer.estimates[0], self.elapsed)
        if self.audit.emergency_stopped(self.services.arming.stops, self.tick):
            self.announce(EMERGENCY_STOP, MAV_SEVERITY_EMERGENCY)
        self.outcome = self.outcome or self._ending

    def stop(self, reason: EndReason) -> Outcome:
        """End the run here, unless it is over already; how it ended."""
        self.outcome = self.outcome or Outcome(reason, self.tick)
        return self.outcome

    def _row(
        self,
        pose: tuple[Number, Number, Number],
        sample: tuple[Number, Number, Number],
        speeds: tuple[Number, Number],
    ) -> TraceRow:
        time, answer = self.elapsed * self._config.sample_time, self._answer
        unsaid: tuple[Number, Number, Number] = (None, None, None)
        estimate = answer.estimates[0].pose if answer.estimates else unsaid
        sent = answer.command.speeds if answer.command else unsaid[:2]
        return TraceRow(self.tick, time, *pose, *sample, *estimate, *sent, *speeds)

    def end(self, reason: EndReason) -> bytes:
        """The frame that tells the station that the run is over."""
        return self._sender.frame(End(self.tick, reason))

    def farewell(self, reason: EndReason) -> list[bytes]:
        """The frame of `end`, after what the station must know of the run and may have missed."""
        stops = self.audit.emergency_stops
        last = [Statustext(MAV_SEVERITY_EMERGENCY, EMERGENCY_STOP.encode())] if stops else []
        return [*self.framed(last), self.end(reason)]
