"""Who would be the station, or the robot, but says so under another name, is named."""

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import NamedTuple

import pytest

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Patience,
    PlantSilentError,
    Relay,
    Safety,
    Services,
    StationSilentError,
    Surroundings,
    serve_lockstep,
    serve_remote,
    standard_parameters,
)
from laglab_protocol import (
    STATION,
    STATION_HEARTBEAT,
    Command,
    Endpoint,
    Listener,
    Message,
    Receiver,
    Sender,
    Settings,
    Tick,
    open_endpoint,
)

CONFIG = GatewayConfig(1, 1, 100, 0.01)
AS_STATION = "system 7, component 9 speaks as a station there: a station must be system 200, "
AS_ROBOT = "system 7, component 9 ticks there: a robot must be system 1, component 1"


class Ends(NamedTuple):
    """Of a link: ours, and somebody's."""

    here: Endpoint
    there: Endpoint


@contextmanager
def link() -> Iterator[Ends]:
    with (
        open_endpoint("udpin://127.0.0.1:0") as here,
        open_endpoint(here.name.replace("udpin", "udpout")) as there,
    ):
        yield Ends(here, there)


def warnings_of_a_gateway_that_waits(sender: Sender, said: Message) -> list[str]:
    """Whose link brings it twice what somebody said."""
    services = Services(standard_parameters(1, 1, Safety()))
    warnings: list[str] = []
    with link() as station, Robot.open(2, RobotParameters()) as robot:
        gateway = Gateway(FmuPlant(robot, RobotParameters()), CONFIG, services=services)
        for _ in range(2):
            station.there.send(sender.frame(said))
        around = Surroundings(
            Listener(station.here, Receiver()), patience=Patience(connect=0.3), warn=warnings.append
        )
        with pytest.raises(StationSilentError):
            serve_lockstep(gateway, around)
    return warnings


@pytest.mark.parametrize(
    "said", [Settings(0.01), Command(0.1, 0.0, 0, 1, 1, 0)], ids=["settings", "command"]
)
def test_a_gateway_that_waits_names_who_may_be_its_station(said: Message) -> None:
    warnings = warnings_of_a_gateway_that_waits(Sender(7, 9), said)
    assert sum(AS_STATION in each for each in warnings) == 1, "once"


def test_who_only_watches_is_not_taken_for_one() -> None:
    """A ground station's heartbeat says nothing of the loop."""
    assert not warnings_of_a_gateway_that_waits(Sender(255, 190), STATION_HEARTBEAT)


def test_a_gateway_that_waits_names_who_may_be_its_robot() -> None:
    services = Services(standard_parameters(1, 1, Safety()), placeable=False)
    relay = Relay(CONFIG, services)
    warnings: list[str] = []
    with link() as station, link() as robot:
        station.there.send(Sender(*STATION).frame(STATION_HEARTBEAT))
        around = Surroundings(
            Listener(station.here, Receiver()), patience=Patience(silence=0.9), warn=warnings.append
        )
        with ThreadPoolExecutor(1) as thread:
            line = Listener(robot.here, Receiver())
            served = thread.submit(serve_remote, relay, line, around)
            stranger = Sender(7, 9)
            while not served.done():
                robot.there.send(stranger.frame(Tick(0, 0)))
                time.sleep(0.02)
        with pytest.raises(PlantSilentError):
            served.result()
    assert [each for each in warnings if "ticks" in each] == [f"{robot.here.name}: {AS_ROBOT}"]
