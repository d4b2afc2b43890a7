"""A gateway in front of another gateway, which is the robot."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from laglab.runs.plant import FmuPlant
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Outcome,
    Patience,
    PlantWaitsError,
    Relay,
    Safety,
    Services,
    Surroundings,
    serve_lockstep,
    serve_remote,
    standard_parameters,
)
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Endpoint,
    EndReason,
    Listener,
    Receiver,
    Sender,
    open_endpoint,
)


def in_lock_step(endpoint: Endpoint) -> Outcome:
    parameters = RobotParameters()
    with Robot.open(3, parameters) as robot:
        gateway = Gateway(FmuPlant(robot, parameters), GatewayConfig(0, 0, 100, 0.01))
        often = Patience(repeat_after=0.02)
        around = Surroundings(Listener(endpoint, Receiver()), patience=often)
        return serve_lockstep(gateway, around).outcome


def test_a_robot_in_lock_step_is_not_taken_for_silent() -> None:
    """Behind a delay of commands it waits for one that waits for its next tick."""
    services = Services(standard_parameters(1, 1, Safety()), placeable=False)
    relay = Relay(GatewayConfig(10, 10, 100, 0.01), services)
    with (
        open_endpoint("udpin://127.0.0.1:0") as robot,
        open_endpoint(robot.name.replace("udpin", "udpout")) as line,
        open_endpoint("udpin://127.0.0.1:0") as endpoint,
        open_endpoint(endpoint.name.replace("udpin", "udpout")) as station,
        ThreadPoolExecutor(1) as thread,
    ):
        ended = thread.submit(in_lock_step, robot)
        station.send(Sender(STATION_SYSTEM, STATION_COMPONENT).frame(STATION_HEARTBEAT))
        around = Surroundings(Listener(endpoint, Receiver()), patience=Patience(silence=3.0))
        with pytest.raises(PlantWaitsError, match=r"repeated its tick 0 .* in lock-step"):
            serve_remote(relay, Listener(line, Receiver()), around)
        assert ended.result(timeout=5).reason is EndReason.FAILED
