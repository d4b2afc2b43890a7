"""The robot's side of the link without clock or I/O: bytes and a tick in, bytes out.

One tick (the order is the specification's): ``open_tick`` samples the sensor and gives the frames
for the station; ``receive`` takes the station's bytes until ``answered``; ``close_tick`` applies
the command that is due and steps the plant.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from laglab_fmu import Reading
from laglab_gateway.delay import DelayLine
from laglab_gateway.errors import CommandError
from laglab_gateway.plant import Plant
from laglab_gateway.services import RobotState, Services, standard_parameters
from laglab_gateway.trace import TraceRow
from laglab_protocol import (
    NO_COMMAND,
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
    Tick,
)


@dataclass(frozen=True)
class GatewayConfig:
    """Delays n and m [ticks], the tick that ends the run, and Ts [s]."""

    command_delay: int
    measurement_delay: int
    last_tick: int
    sample_time: float


class Outcome(NamedTuple):
    """How a run ended, and at which tick."""

    reason: EndReason
    tick: int


def from_station(frame: Frame) -> bool:
    """Whether the remote station sent it: nobody else may command."""
    return (frame.system, frame.component) == (STATION_SYSTEM, STATION_COMPONENT)


class Gateway:
    """A plant behind two delay lines, in lock-step with a remote station."""

    def __init__(
        self,
        plant: Plant,
        config: GatewayConfig,
        services: Services | None = None,
        codec: Codec | None = None,
    ) -> None:
        self.tick = 0
        self.connected = False
        self.outcome: Outcome | None = None
        self.station_end: End | None = None
        self._config = config
        self._plant = plant
        delays = (config.command_delay, config.measurement_delay)
        self.services = services or Services(standard_parameters(*delays))
        codec = codec or Codec(ROBOT_SYSTEM, ROBOT_COMPONENT)
        self._sender, self._receiver = codec.sender, codec.receiver
        self._replies: list[Message] = []
        self._measurements: DelayLine[Measurement] = DelayLine(config.measurement_delay)
        self._commands: DelayLine[Command] = DelayLine(config.command_delay)
        self._in_force: Command | None = None
        self._applied = (0.0, 0.0)
        self._begin_tick()

    def _begin_tick(self) -> None:
        if pose := self.services.arming.take_reset():
            self._plant.place(*pose)
        self._reading: Reading = self._plant.read()
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
        """Sample the sensor at k; the frames: each z that is m ticks old now, then the tick."""
        self._measurements.push(self.tick, self._sample())
        due = self._measurements.due(self.tick)
        self._batch = [*due, Tick(self.tick, len(due))]
        return self.repeat_tick()

    def repeat_tick(self) -> list[bytes]:
        """The same messages in new frames: the station may have missed the first."""
        return [self._sender.frame(message) for message in self._batch]

    def _sample(self) -> Measurement:
        reading, force = self._reading, self._in_force
        return Measurement(
            reading.x_meas,
            reading.y_meas,
            reading.theta_meas,
            *self._applied,
            self.tick,
            force.tick if force else NO_COMMAND,
        )

    def _apply(self) -> tuple[float, float]:
        """The speeds from now on: of the last command due, as far as the robot may follow it."""
        force = self._in_force
        self._applied = self.services.allow(force.v, force.omega) if force else (0.0, 0.0)
        return self._applied

    def receive(self, data: bytes, whole: bool) -> list[Frame]:
        """Take bytes from the link; returns the frames in them. No frame goes on after ``whole``.

        Raises:
            CommandError: the station commands a speed that is not finite.
        """
        frames = self._receiver.receive(data)
        if whole:
            frames += self._receiver.end_datagram()
        for frame in frames:
            if not from_station(frame) or not self._take(frame.message):
                self._replies += self.services.answer(frame, self.state)
        return frames

    def take_replies(self) -> list[bytes]:
        """The frames that answer requests since the last call: not of the loop, to be sent too."""
        replies, self._replies = self._replies, []
        return [self._sender.frame(message) for message in replies]

    def _take(self, message: Message) -> bool:
        """Take what belongs to the loop; False when it does not."""
        match message:
            case Command() | Estimate() if message.tick != self.tick or self.answered:
                pass  # of another tick, or said again
            case Estimate():
                self._estimates.append(message)
            case Command():
                self._take_command(message)
            case Heartbeat():
                self.connected = True
            case End():
                self.station_end = message
            case _:
                return False
        return True

    def _take_command(self, command: Command) -> None:
        if len(self._estimates) < command.estimates:
            return  # a frame of this answer was lost: the repeat will bring it whole
        if not (math.isfinite(command.v) and math.isfinite(command.omega)):
            raise CommandError(command.tick, command.v, command.omega)
        self._command = command

    def close_tick(self) -> TraceRow:
        """Apply u_{k-n}, step to k + 1 unless k is the last tick, and say what happened at k."""
        assert self._command is not None, "close_tick before the station's answer"
        self._commands.push(self.tick, self._command)
        for command in self._commands.due(self.tick):
            self._in_force = command
        row = self._row(self._command)
        if self.station_end is not None:
            self.outcome = Outcome(EndReason(self.station_end.reason), self.tick)
        elif self.tick == self._config.last_tick:
            self.outcome = Outcome(EndReason.COMPLETED, self.tick)
        else:
            self._plant.step(row.v, row.omega)
            self.tick += 1
            self._begin_tick()
        return row

    def _row(self, sent: Command) -> TraceRow:
        x_est, y_est, theta_est = self._estimates[0][:3] if self._estimates else (None,) * 3
        v, omega = self._apply()
        return TraceRow(
            self.tick,
            self.tick * self._config.sample_time,
            *self._reading[:6],
            x_est,
            y_est,
            theta_est,
            sent.v,
            sent.omega,
            v,
            omega,
        )

    def end(self, reason: EndReason) -> bytes:
        """The frame that tells the station that the run is over."""
        return self._sender.frame(End(self.tick, reason))
