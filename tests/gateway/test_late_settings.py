"""Peers that tell what they were told late, on a stream, or never."""

import pytest

from laglab.runs.plant.shipped import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    MemoryRecorder,
    Patience,
    Relay,
    Safety,
    Services,
    Surroundings,
    serve_lockstep,
    standard_parameters,
)
from laglab_gateway.loops.remote import RobotLine
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    TELLS_WITHIN,
    End,
    EndReason,
    Link,
    Listener,
    Receiver,
    Sender,
    Settings,
    SettingsError,
)

SENDER = Sender(STATION_SYSTEM, STATION_COMPONENT)
CALL = SENDER.frame(STATION_HEARTBEAT)


class Told(Link):
    """A stream that brings one thing after the other, the station's END, and nothing more."""

    name = "told"
    datagrams = False

    def __init__(self, *coming: bytes) -> None:
        self._coming = [*coming, SENDER.frame(End(0, EndReason.INTERRUPTED))]

    def fileno(self) -> int:
        return -1

    def send(self, data: bytes, to: object = None) -> None: ...

    def receive(self, _: float) -> bytes:
        return self._coming.pop(0) if self._coming else b""


class Datagrams(Told):
    """The same, one by one."""

    datagrams = True


def warnings_of(link: Link) -> list[str]:
    """Of a gateway at the other end."""
    parameters, said = RobotParameters(), list[str]()
    with Robot.open(3, parameters) as robot:
        gateway = Gateway(FmuPlant(robot, parameters), GatewayConfig(0, 0, 100, 0.01))
        around = Surroundings(Listener(link, Receiver()), MemoryRecorder(), warn=said.append)
        serve_lockstep(gateway, around)
    return said


def told_later(settings: Settings) -> Told:
    """In pieces, after the heartbeat."""
    raw = SENDER.frame(settings)
    return Told(CALL, b"", raw[:9], raw[9:])


def test_what_follows_a_heartbeat_is_waited_for_on_a_stream() -> None:
    (said,) = warnings_of(told_later(Settings(0.01, command_delay=7)))
    assert said.startswith("the two sides were told different things: n: 0 ticks for the robot, 7")
    with pytest.raises(SettingsError, match=r"0\.02"):
        warnings_of(told_later(Settings(0.02)))


def test_a_station_that_tells_ever_other_things_is_named_once() -> None:
    for link in (Told, Datagrams):
        said = warnings_of(
            link(CALL, *(SENDER.frame(Settings(0.01, track=k)) for k in range(1, 99)))
        )
        assert said[-1] == "the controller goes on changing its settings"
        assert len(said) <= 7, "else it fills the screen"


def test_a_station_that_never_tells_is_noted() -> None:
    (said,) = warnings_of(Datagrams(CALL))
    assert said == "the controller does not tell its settings: nothing to compare with ours"


def test_a_real_robot_has_a_moment_to_tell_and_is_compared_with_whenever_it_does() -> None:
    relay = Relay(GatewayConfig(1, 1, 100, 0.01), Services(standard_parameters(1, 1, Safety())))
    line = RobotLine(relay, Listener(Told(), Receiver()), Patience())
    assert line.compare_settings() == "", "its first tick"
    assert line.missed_settings(TELLS_WITHIN) == ""
    assert line.missed_settings(0.0).startswith("the robot does not tell its settings")
    assert line.missed_settings(0.0) == "", "once"
    relay.robot_settings = Settings(0.01, track=0.7)
    assert line.compare_settings() == ""  # of a track that we do not know
    relay.robot_settings = Settings(0.02)
    with pytest.raises(SettingsError, match=r"0\.02"):
        line.compare_settings()
