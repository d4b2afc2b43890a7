"""The conformance kit passes our own robot, over UDP and over a serial line, signed and not."""

import threading
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    FmuPlant,
    Gateway,
    GatewayConfig,
    NoRecorder,
    Patience,
    Watch,
    serve_lockstep,
)
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Codec,
    Endpoint,
    make_key,
    open_endpoint,
)
from laglab_protocol.conform import conform

PARAMETERS = RobotParameters(start=(-3.0, -2.0, 0.0), noise=True)


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as opened:
        yield opened


def serve(endpoint: Endpoint, key_file: Path | None) -> None:
    config = GatewayConfig(3, 5, 10**6, PARAMETERS.sample_time)
    with (
        Robot.open(3, PARAMETERS) as robot,
        Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, key_file) as codec,
    ):
        gateway = Gateway(FmuPlant(robot, PARAMETERS), config, codec=codec)
        watch, patience = Watch(gateway.services, []), Patience(0.05, 3.0, 5.0)
        serve_lockstep(
            gateway, endpoint, NoRecorder(), patience, progress=lambda _: None, watch=watch
        )


@pytest.mark.slow
@pytest.mark.parametrize("signed", [False, True], ids=["unsigned", "signed"])
@pytest.mark.parametrize("line", ["udp", "serial"])
def test_our_robot_conforms(stack: ExitStack, tmp_path: Path, line: str, signed: bool) -> None:
    key_file = tmp_path / "key" if signed else None
    if key_file:
        make_key(key_file)
    pty = f"pty://{tmp_path / 'robot'}"
    endpoint = stack.enter_context(open_endpoint("udpin://:0" if line == "udp" else pty))
    url = endpoint.name.replace("udpin", "udpout").replace("pty", "serial")
    robot = threading.Thread(target=serve, args=(endpoint, key_file))
    robot.start()
    try:
        report = conform(url if line == "udp" else f"{url}:57600", "robot", key_file)
    finally:
        robot.join()

    assert report.failed == [], report.table()
