"""A relay between a robot and a station that are made of the codec alone."""

from itertools import count

from laglab_gateway import (
    GatewayConfig,
    RandomFates,
    Relay,
    Safety,
    Services,
    TraceRow,
    standard_parameters,
)
from laglab_gateway.speakers import from_robot
from laglab_protocol import (
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Applied,
    Command,
    Measurement,
    Message,
    Recall,
    Receiver,
    Sender,
    Tick,
    frames_in,
)

TS = 0.01


def heard(frames: list[bytes]) -> list[Message]:
    return [frame.message for frame in Receiver().receive(b"".join(frames))]


class Robot:
    """Ticks; the newest command of those received is in force from its next tick on."""

    def __init__(self, first: int = 0) -> None:
        self.ticks = count(first)
        self.sender = Sender(ROBOT_SYSTEM, ROBOT_COMPONENT)
        self.received: list[Message] = []
        self.in_force = (0.0, 0.0, NO_COMMAND)

    def tick(self) -> bytes:
        k = next(self.ticks)
        v, omega, stamp = self.in_force
        told = self._told()
        for command in self.received:
            if isinstance(command, Command):
                self.in_force = (command.v, command.omega, command.tick)
        self.received.clear()
        sample = Measurement(float(k), -k / 2, k / 8, v, omega, k, stamp)
        return b"".join(map(self.sender.frame, (*told, sample, Tick(k, 1 + len(told)))))

    def _told(self) -> list[Message]:
        """What it was asked by its rules: before a command that says so."""
        before: list[Recall] = []
        told: list[Message] = []
        for message in self.received:
            if isinstance(message, Recall):
                before.append(message)
            elif isinstance(message, Command):
                assert message.estimates == len(before)
                told += [Applied((0.25,) * 12, (0.5,) * 12, each.first, 12) for each in before]
                before.clear()
        return told


class Rig:
    """The robot, the relay and a station that answers each tick with v = tick / 1000."""

    def __init__(self, relay: Relay, first: int = 0) -> None:
        self.relay = relay
        self.robot = Robot(first)
        self.station = Sender(STATION_SYSTEM, STATION_COMPONENT)
        self.receiver = Receiver()
        self.rows: list[TraceRow] = []
        self.told: list[list[Message]] = []

    def feed(self, data: bytes) -> None:
        for frame in self.receiver.receive(data):
            if not from_robot(frame) or not self.relay.hear_robot(frame):
                continue
            if self.relay.under_way:
                self.rows.append(self.relay.close_tick())
            if self.relay.outcome is None:
                self.told.append(heard(self.relay.open_tick()))

    def say(self, *messages: Message) -> list[Message]:
        return heard(self.relay.hear(frames_in(b"".join(map(self.station.frame, messages)))))

    def forward(self) -> list[Message]:
        forwarded = heard(self.relay.forward())
        self.robot.received += forwarded
        return forwarded

    def run(self, ticks: int) -> None:
        for _ in range(ticks):
            self.feed(self.robot.tick())
            self.forward()
            self.say(Command(self.relay.tick / 1000, 0.0, self.relay.tick, 1, 1, 0))
            self.forward()


def relay(
    n: int = 1,
    m: int = 0,
    last_tick: int = 10**6,
    safety: Safety | None = None,
    commands: RandomFates | None = None,
) -> Relay:
    safety = safety or Safety()
    services = Services(standard_parameters(n, m, safety), placeable=False)
    config = GatewayConfig(n, m, last_tick, TS, safety)
    return Relay(config, services, {"command": commands} if commands else None)
