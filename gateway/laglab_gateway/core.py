"""The robot's side of the link without clock or I/O: bytes and a tick in, bytes out.

One tick (the order is the specification's): `open_tick` samples the sensor and gives the frames
for the station; `receive` takes the station's bytes; `settle` lets the commands that are due come
into force; `close_tick` says what happened and steps the plant. In lock-step `settle` waits for
the answer to this tick, so that n = 0 means no delay; in real time it comes right after
`open_tick`, so what arrives during a tick counts from the next one on.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from laglab_gateway.audit import Audit, DirectionAudit
from laglab_gateway.channel import Channel
from laglab_gateway.drive import Drive, Safety, follow, refusal, speeds, supervise
from laglab_gateway.fates import Fates, Kind
from laglab_gateway.linklog import LinkRow
from laglab_gateway.plant import Plant
from laglab_gateway.services import RobotState, Services, standard_parameters
from laglab_gateway.timeline import Direction
from laglab_gateway.trace import TraceRow
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Codec,
    Command,
    End,
    EndReason,
    Estimate,
    Frame,
    Heartbeat,
    Measurement,
    Message,
    Statustext,
    Tick,
)


@dataclass(frozen=True)
class GatewayConfig:
    """Delays n and m [ticks], the tick that ends the run, Ts [s], what else the link does."""

    command_delay: int
    measurement_delay: int
    last_tick: int
    sample_time: float
    safety: Safety = field(default_factory=Safety)


class Outcome(NamedTuple):
    """How a run ended, and at which tick."""

    reason: EndReason
    tick: int


def from_station(frame: Frame) -> bool:
    """Whether the remote station sent it: nobody else may command."""
    return (frame.system, frame.component) == (STATION_SYSTEM, STATION_COMPONENT)


MAV_SEVERITY_WARNING = 4


class Gateway:
    """A plant at the end of a link that is late, and perhaps worse."""

    def __init__(
        self,
        plant: Plant,
        config: GatewayConfig,
        fates: Mapping[Direction, Fates] | None = None,
        services: Services | None = None,
        codec: Codec | None = None,
    ) -> None:
        n, m, Ts = config.command_delay, config.measurement_delay, config.sample_time
        self.tick = 0
        self.connected = False
        self.outcome: Outcome | None = None
        self.station_end: End | None = None
        self.audit = Audit(DirectionAudit(n), DirectionAudit(m))
        self._config = config
        self._plant = plant
        codec = codec or Codec(ROBOT_SYSTEM, ROBOT_COMPONENT)
        self._sender, self._receiver = codec.sender, codec.receiver
        self.services = services or Services(standard_parameters(n, m, config.safety))
        self._replies: list[Message] = []
        self._notices: list[Message] = []
        fates = fates or {}
        self._commands: Channel[Command] = Channel("command", n, Ts, fates.get("command"))
        self._measurements: Channel[Measurement] = Channel(
            "measurement", m, Ts, fates.get("measurement")
        )
        self._answered_through = -1
        self._drive = Drive()
        self._speeds = (0.0, 0.0)
        self._begin_tick()

    def _begin_tick(self) -> None:
        if pose := self.services.arming.take_reset():
            self._plant.place(*pose)
        self._reading = self._plant.read()
        self._batch: list[Message] = []
        self._estimates: list[Estimate] = []
        self._command: Command | None = None

    @property
    def time_us(self) -> int:
        """Simulation time of this tick [µs]."""
        return round(self.tick * self._config.sample_time * 1e6)

    @property
    def state(self) -> RobotState:
        """The robot at this tick, for those who ask."""
        reading = self._reading
        return RobotState(
            self.time_us, reading.x, reading.y, reading.theta, reading.v, reading.omega
        )

    @property
    def answered(self) -> bool:
        """Whether the station has said all it has to say on this tick."""
        return self._command is not None

    def open_tick(self) -> list[bytes]:
        """Sample the sensor at k; the frames: each z that has come across the link, the tick."""
        self._measurements.push(self.tick, self._sample())
        due = [crossing.message for crossing in self._measurements.due(self.tick)]
        for measurement in due:
            self.audit.measurement.arrived(measurement.tick, self.tick)
        self._batch = [*due, Tick(self.tick, len(due))]
        return self.repeat_tick()

    def repeat_tick(self) -> list[bytes]:
        """The same messages in new frames: the station may have missed the first."""
        return [self._sender.frame(message) for message in self._batch]

    def _sample(self) -> Measurement:
        """z_k, and the command in force on [t_{k-1}, t_k)."""
        _, _, _, x, y, theta, *_ = self._reading
        return Measurement(x, y, theta, *self._speeds, self.tick, self._drive.command_tick)

    def receive(self, data: bytes, whole: bool) -> list[Frame]:
        """Take bytes from the link; returns the frames in them. No frame goes on after `whole`."""
        frames = self._receiver.receive(data)
        if whole:
            frames += self._receiver.end_datagram()
        for frame in frames:
            if not from_station(frame) or not self._take(frame.message):
                self._replies += self.services.answer(frame, self.state)
        return frames

    def _take(self, message: Message) -> bool:
        """Take what belongs to the loop; False when it does not."""
        match message:
            case Heartbeat():
                self.connected = True
            case Estimate() if message.tick == self.tick and not self.answered:
                self._estimates.append(message)
            case Command() if message.tick == self.tick and not self.answered:
                self._take_answer(message)
            case Command() if self._answered_through < message.tick < self.tick:
                self._push(message)
            case Command() | Estimate():
                pass  # said again, or of a tick that has not come
            case End():
                self.station_end = message
            case _:
                return False
        return True

    def _take_answer(self, command: Command) -> None:
        if len(self._estimates) < command.estimates:
            return  # a frame of this answer was lost: the repeat will bring it whole
        self._command = command
        self._push(command)

    def _push(self, command: Command) -> None:
        self._answered_through = command.tick
        self._commands.push(self.tick, command)

    def settle(self) -> None:
        """Let the commands that have come across the link take force, and the failsafe watch."""
        k, Ts, safety = self.tick, self._config.sample_time, self._safety()
        for command, _ in self._commands.due(k):
            self.audit.command.arrived(command.tick, k)
            if refused := refusal(self._drive, command, safety):
                self.audit.refused[refused] += 1
            else:
                self._drive = follow(command, k)
        supervised = supervise(self._drive, k, Ts, safety)
        if supervised.mode is not self._drive.mode:
            self.audit.stops.append(k)
            self.announce(f"no fresh command for {safety.link_timeout} s: stopping")
        self._drive = supervised
        armed = self.services.arming.armed
        self._speeds = speeds(self._drive, k, Ts, safety) if armed else (0.0, 0.0)

    def _safety(self) -> Safety:
        """The limits and times now: ground stations may set some of them."""
        now = self.services.parameters
        limits = (now["V_MAX"] or None, now["OMEGA_MAX"] or None)
        return Safety(*limits, now["LINK_TIMEOUT"], self._config.safety.ramp)

    def announce(self, text: str) -> None:
        """Warn everybody who listens, in at most 50 characters, at the end of this tick."""
        self._notices.append(Statustext(MAV_SEVERITY_WARNING, text.encode()[:50]))

    def take_replies(self) -> list[bytes]:
        """The frames that answer requests since the last call: not of the loop, to be sent too."""
        replies, self._replies = self._replies, []
        return [self._sender.frame(message) for message in replies]

    def take_notices(self) -> list[Message]:
        """What the robot did by itself since the last call: everybody is told."""
        notices, self._notices = self._notices, []
        self._replies += notices
        return notices

    def take_link_rows(self) -> list[LinkRow]:
        """What the link did to the frames that entered it since the last call."""
        measurements, commands = self._measurements.take_log(), self._commands.take_log()
        self.audit.measurement.fates.update(Kind(row.fate) for row in measurements)
        self.audit.command.fates.update(Kind(row.fate) for row in commands)
        return [*measurements, *commands]

    def close_tick(self) -> TraceRow:
        """Step to k + 1, unless the run ends at k; says what happened at k."""
        row = self._row()
        self.audit.unanswered += not self.answered
        if self.station_end is not None:
            self.outcome = Outcome(EndReason(self.station_end.reason), self.tick)
        elif self.tick == self._config.last_tick:
            self.outcome = Outcome(EndReason.COMPLETED, self.tick)
        else:
            self._plant.step(*self._speeds)
            self.tick += 1
            self._begin_tick()
        return row

    def _row(self) -> TraceRow:
        x_est, y_est, theta_est = self._estimates[0][:3] if self._estimates else (None,) * 3
        v_sent, omega_sent = self._command[:2] if self._command else (None, None)
        return TraceRow(
            self.tick,
            self.tick * self._config.sample_time,
            *self._reading[:6],
            x_est,
            y_est,
            theta_est,
            v_sent,
            omega_sent,
            *self._speeds,
        )

    def end(self, reason: EndReason) -> bytes:
        """The frame that tells the station that the run is over."""
        return self._sender.frame(End(self.tick, reason))
