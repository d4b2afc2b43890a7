"""The conformance kit passes our own robot, over UDP and over a serial line, signed and not."""

import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from laglab.runs.plant import FmuPlant
from laglab_conformance import Mark, Pace, conform
from laglab_conformance import Waits as Quick
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    Gateway,
    GatewayConfig,
    Patience,
    StationSilentError,
    Surroundings,
    serve_lockstep,
    serve_realtime,
)
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Codec,
    Endpoint,
    Listener,
    make_key,
    open_endpoint,
)

PARAMETERS = RobotParameters(start=(-3.0, -2.0, 0.0), noise=True)


def serve(endpoint: Endpoint, key_file: Path | None, pace: Pace, ticks: int = 10**6) -> None:
    config = GatewayConfig(3, 5, ticks, PARAMETERS.sample_time)
    with (
        Robot.open(3, PARAMETERS) as robot,
        Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, key_file) as codec,
    ):
        gateway = Gateway(FmuPlant(robot, PARAMETERS), config, sender=codec.sender)
        patience = Patience(0.05, 3.0, 5.0)
        around = Surroundings(Listener(endpoint, codec.receiver), patience=patience)
        if pace == "lockstep":
            serve_lockstep(gateway, around)
        else:
            serve_realtime(gateway, around, PARAMETERS.sample_time)


@contextmanager
def served(endpoint: Endpoint, *how: Any) -> Iterator[str]:
    """The robot in a thread of its own; the address to reach it at."""
    robot = threading.Thread(target=serve, args=(endpoint, *how))
    robot.start()
    try:
        yield endpoint.name.replace("udpin", "udpout").replace("pty", "serial")
    finally:
        robot.join()


@pytest.mark.slow
@pytest.mark.parametrize("signed", [False, True], ids=["unsigned", "signed"])
@pytest.mark.parametrize(
    ("line", "pace"), [("udp", "lockstep"), ("serial", "lockstep"), ("udp", "realtime")]
)
def test_our_robot_conforms(
    stack: ExitStack, tmp_path: Path, line: str, pace: Pace, signed: bool
) -> None:
    key_file = tmp_path / "key" if signed else None
    if key_file:
        make_key(key_file)
    pty = f"pty://{tmp_path / 'robot'}"
    endpoint = stack.enter_context(open_endpoint("udpin://:0" if line == "udp" else pty))
    with served(endpoint, key_file, pace) as url:
        at = url if line == "udp" else f"{url}:57600"
        report = conform(at, "robot", key_file, pace=pace)

    assert report.failed == [], report.table()


def test_our_robot_gives_up_a_silent_station(stack: ExitStack) -> None:
    endpoint = stack.enter_context(open_endpoint("udpin://:0"))
    url = endpoint.name.replace("udpin", "udpout")
    robot = stack.enter_context(ThreadPoolExecutor(1)).submit(serve, endpoint, None, "lockstep")
    report = conform(url, "robot", None, Quick(3.0, 1.0, 0.1), scope="silence")

    assert report.failed == [], report.table()
    with pytest.raises(StationSilentError):
        robot.result()


def test_a_run_that_ends_too_soon_is_told_from_a_robot_that_is_deaf(stack: ExitStack) -> None:
    endpoint = stack.enter_context(open_endpoint("udpin://:0"))
    with served(endpoint, None, "lockstep", 3) as url:
        report = conform(url, "robot", None, Quick(3.0, 0.2, 0.02))

    assert not report.conforms
    assert "its run had ended at tick 3: let it run longer" in report.table()


def test_a_kit_that_is_interrupted_tells_what_it_saw_and_lets_the_robot_go(
    stack: ExitStack,
) -> None:
    """The robot stands still at once, and not after its silence timeout: that would be an error in
    its thread, which pytest takes for ours."""
    tried: list[str] = []

    def interrupted(text: str) -> None:
        tried.append(text)
        if len(tried) == 6:  # the first text is where the peer is
            raise KeyboardInterrupt

    endpoint = stack.enter_context(open_endpoint("udpin://:0"))
    with served(endpoint, None, "lockstep") as url:
        report = conform(url, "robot", None, progress=interrupted)
    marks = [each.mark for each in report.results]
    assert marks[:4] == [Mark.PASSED] * 4
    assert set(marks[4:]) == {Mark.INTERRUPTED}
    assert not report.is_whole
    assert not report.conforms
    assert report.table().endswith("the robot was not tested to the end")
