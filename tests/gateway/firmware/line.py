"""A line to the robot in C: a pty, and a station made of the codec alone."""

import time
from collections.abc import Callable
from typing import NamedTuple

from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_HEARTBEAT,
    Command,
    Endpoint,
    Measurement,
    Message,
    Receiver,
    Sender,
)

SPEED = 4.0


PERIOD = 0.01 / SPEED


class Line(NamedTuple):
    """What a station has of the robot."""

    endpoint: Endpoint
    sender: Sender
    receiver: Receiver

    def say(self, *messages: Message) -> None:
        self.endpoint.send(b"".join(map(self.sender.frame, messages)))

    def hear(self, seconds: float) -> list[Message]:
        """All that comes within so long a time."""
        deadline = time.monotonic() + seconds
        heard: list[Message] = []
        while (left := deadline - time.monotonic()) > 0:
            heard += self._next(left)
        return heard

    def hear_until(self, done: Callable[[Message], bool]) -> list[Message]:
        """All that comes up to a message, and in one piece with it."""
        heard: list[Message] = []
        while not any(map(done, heard)):
            heard += self._next(5.0)
        return heard

    def samples(self, number: int) -> list[Measurement]:
        """So many measurements, or a few more."""
        heard: list[Measurement] = []
        while len(heard) < number:
            heard += [each for each in self._next(5.0) if isinstance(each, Measurement)]
        return heard

    def samples_from(self, stamp: int, number: int) -> list[Measurement]:
        """So many measurements, or a few more, from the first that echoes a command on."""
        heard: list[Measurement] = []
        while len(heard) < number:
            heard += [each for each in self.samples(1) if heard or each.command_tick == stamp]
        return heard

    def _next(self, timeout: float) -> list[Message]:
        frames = self.receiver.receive(self.endpoint.receive(timeout))
        return [frame.message for frame in frames]


def begin(line: Line) -> Measurement:
    """Its first measurement; the robot may take a moment to open the port."""
    heard: list[Message] = []
    while not heard:
        line.say(STATION_HEARTBEAT)
        heard = line.hear(0.02)
    assert isinstance(heard[0], Measurement)
    return heard[0]


def command(tick: int, v: float, omega: float = 0.0) -> Command:
    return Command(v, omega, tick, ROBOT_SYSTEM, ROBOT_COMPONENT, 0)
