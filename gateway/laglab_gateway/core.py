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
from laglab_gateway.trace import TraceRow
from laglab_protocol import (
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    End,
    EndReason,
    Estimate,
    Frame,
    Heartbeat,
    Measurement,
    Message,
    Receiver,
    Sender,
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

    def __init__(self, plant: Plant, config: GatewayConfig) -> None:
        self.tick = 0
        self.connected = False
        self.outcome: Outcome | None = None
        self.station_end: End | None = None
        self._config = config
        self._plant = plant
        self._sender = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
        self._receiver = Receiver()
        self._measurements: DelayLine[Measurement] = DelayLine(config.measurement_delay)
        self._commands: DelayLine[Command] = DelayLine(config.command_delay)
        self._in_force: Command | None = None
        self._begin_tick()

    def _begin_tick(self) -> None:
        self._reading: Reading = self._plant.read()
        self._batch: list[Message] = []
        self._estimates: list[Estimate] = []
        self._command: Command | None = None

    @property
    def time_us(self) -> int:
        """Simulation time of this tick [µs]."""
        return round(self.tick * self._config.sample_time * 1e6)

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
        v, omega, command_tick = (
            (force.v, force.omega, force.tick) if force else (0.0, 0.0, NO_COMMAND)
        )
        return Measurement(
            reading.x_meas,
            reading.y_meas,
            reading.theta_meas,
            v,
            omega,
            self.tick,
            command_tick,
        )

    def receive(self, data: bytes, whole: bool) -> list[Frame]:
        """Take bytes from the link; returns the frames in them. No frame goes on after ``whole``.

        Raises:
            CommandError: the station commands a speed that is not finite.
        """
        frames = self._receiver.receive(data)
        if whole:
            frames += self._receiver.end_datagram()
        for frame in frames:
            if from_station(frame):
                self._take(frame.message)
        return frames

    def _take(self, message: Message) -> None:
        match message:
            case Heartbeat():
                self.connected = True
            case Estimate(tick=tick) if tick == self.tick and not self.answered:
                self._estimates.append(message)
            case Command(tick=tick) if tick == self.tick and not self.answered:
                self._take_command(message)
            case End():
                self.station_end = message

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
        v, omega = (self._in_force.v, self._in_force.omega) if self._in_force else (0.0, 0.0)
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
