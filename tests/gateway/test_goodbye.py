"""How a gateway takes its leave of a station that never came."""

from laglab.runs.plant.shipped import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import Gateway, GatewayConfig, MemoryRecorder, Surroundings, serve_lockstep
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    End,
    EndReason,
    Link,
    Listener,
    Receiver,
    Sender,
    frames_in,
)


class Interrupted(Link):
    """Nobody there, and Ctrl-C."""

    name = "interrupted"
    datagrams = True

    def __init__(self) -> None:
        self.ends: list[End] = []
        self._pressed = False

    def fileno(self) -> int:
        return -1

    def send(self, data: bytes, _: object = None) -> None:
        told = [frame.message for frame in frames_in(data)]
        self.ends += [message for message in told if isinstance(message, End)]

    def receive(self, _: float) -> bytes:
        if not self._pressed:
            self._pressed = True
            raise KeyboardInterrupt
        return b""


class Busy(Interrupted):
    """At the end of a stream a station that has no time, but for a beginning; then Ctrl-C."""

    datagrams = False

    def __init__(self, until: int) -> None:
        super().__init__()
        self._until = until
        self._sender = Sender(STATION_SYSTEM, STATION_COMPONENT)
        self._met = False

    def receive(self, timeout: float) -> bytes:
        if not self._met:
            self._met = True
            return self._sender.frame(STATION_HEARTBEAT)
        if len(self.ends) < self._until:
            return super().receive(timeout)
        return self._sender.frame(End(0, EndReason.INTERRUPTED))


def test_on_a_stream_a_busy_station_is_told_for_longer() -> None:
    """For what it has not read yet goes with the port."""
    link, parameters = Busy(until=12), RobotParameters()
    with Robot.open(3, parameters) as robot:
        gateway = Gateway(FmuPlant(robot, parameters), GatewayConfig(0, 0, 100, 0.01))
        around = Surroundings(Listener(link, Receiver()), MemoryRecorder())
        served = serve_lockstep(gateway, around)
    assert served.outcome.reason == EndReason.INTERRUPTED
    assert len(link.ends) == 12


def test_nobody_is_waited_for_who_never_came() -> None:
    """Or a Ctrl-C, while the two sides are about to meet, would take seconds."""
    link, parameters = Interrupted(), RobotParameters()
    with Robot.open(3, parameters) as robot:
        gateway = Gateway(FmuPlant(robot, parameters), GatewayConfig(0, 0, 100, 0.01))
        around = Surroundings(Listener(link, Receiver()), MemoryRecorder())
        served = serve_lockstep(gateway, around)
    assert served.outcome.reason == EndReason.INTERRUPTED
    assert [end.reason for end in link.ends] == [EndReason.INTERRUPTED]
