"""A real robot's own link, signed with a key of its own."""

import json
import re
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from laglab.command import main
from laglab_gateway import (
    GatewayConfig,
    PlantSilentError,
    Relay,
    Safety,
    Services,
    Surroundings,
    serve_remote,
    standard_parameters,
)
from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Codec,
    Listener,
    Receiver,
    Sender,
    Tick,
    make_key,
    open_endpoint,
)

Process = Any
Start = Callable[..., Process]
LAGLAB = (sys.executable, "-m", "laglab")


@pytest.fixture
def keys(tmp_path: Path) -> tuple[Path, Path]:
    """The robot's and the station's."""
    for name in ("robot.key", "station.key"):
        make_key(tmp_path / name)
    return tmp_path / "robot.key", tmp_path / "station.key"


def behind(start: Start, port: Path, *options: object) -> Process:
    """A run with the robot that will be at this port, which is there now."""
    plant = ("--plant", f"pty://{port}", "--duration", "2", "--out", "run")
    run = start(*LAGLAB, "run", "lab", *plant, *options)
    while not port.is_symlink():
        assert run.poll() is None
        time.sleep(0.02)
    return run


def test_a_signed_robot_runs_a_scenario_to_its_end(
    start: Start, firmware: Path, tmp_path: Path, keys: tuple[Path, Path]
) -> None:
    key, station_key = keys
    port = tmp_path / "port"
    run = behind(start, port, "--plant-key", key, "--key", station_key)
    robot = start(firmware, "--speed", 2, "--key", key, port)
    _, errors = run.communicate(timeout=30)

    assert run.returncode == 0, errors
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["ticks"] == 200
    assert "frames refused" not in robot.communicate(timeout=5)[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ours", "why"),
    [
        (True, "not signed with this key: give both sides the same --key"),
        (False, "not signed: give the sender the same --key"),
    ],
    ids=["another key", "no key"],
)
def test_the_robot_says_why_it_does_not_begin(
    start: Start, firmware: Path, tmp_path: Path, keys: tuple[Path, Path], ours: bool, why: str
) -> None:
    key, other = keys
    port = tmp_path / "port"
    run = behind(start, port, *(["--plant-key", other] if ours else []))
    robot = start(firmware, "--key", key, port)

    assert robot.stderr.readline() == f"{port}: frames refused: {why}\n"
    _, errors = run.communicate(timeout=20)
    assert run.returncode == 4
    assert "the robot never spoke" in errors
    assert "--plant-key" in errors


def test_a_robot_without_a_key_says_that_it_needs_one(
    start: Start, firmware: Path, tmp_path: Path, keys: tuple[Path, Path]
) -> None:
    port = tmp_path / "port"
    behind(start, port, "--plant-key", keys[0])
    robot = start(firmware, port)
    assert "signed, and there is no key here to tell by whom" in robot.stderr.readline()


def test_a_robot_under_way_with_another_key_is_named(keys: tuple[Path, Path]) -> None:
    relay = Relay(
        GatewayConfig(1, 1, 100, 0.01),
        Services(standard_parameters(1, 1, Safety()), placeable=False),
    )
    said: list[str] = []
    with (
        open_endpoint("udpin://127.0.0.1:0") as line,
        open_endpoint(line.name.replace("udpin", "udpout")) as robot,
        open_endpoint("udpin://127.0.0.1:0") as endpoint,
        open_endpoint(endpoint.name.replace("udpin", "udpout")) as station,
        Codec(ROBOT_SYSTEM, ROBOT_COMPONENT, keys[1]) as theirs,
        Codec(STATION_SYSTEM, STATION_COMPONENT, keys[0]) as ours,
    ):
        station.send(Sender(STATION_SYSTEM, STATION_COMPONENT).frame(STATION_HEARTBEAT))
        around = Surroundings(Listener(endpoint, Receiver()), warn=said.append)
        with ThreadPoolExecutor(1) as thread:
            served = thread.submit(serve_remote, relay, Listener(line, ours.receiver), around)
            while not served.done():
                robot.send(theirs.sender.frame(Tick(0, 0)))
                time.sleep(0.02)
        with pytest.raises(PlantSilentError, match="the robot never spoke"):
            served.result()

    mend = "not signed with this key: give both sides the same --plant-key"
    told = re.escape(f"{line.name}: ") + r"\d+ frames refused: " + re.escape(mend)
    assert any(re.fullmatch(told, each) for each in said)


def refused(capsys: pytest.CaptureFixture[str], *options: str) -> str:
    with pytest.raises(SystemExit) as ended:
        main(["gateway", "lab", "--endpoint", "udpin://127.0.0.1:0", *options])
    assert ended.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    return line


def test_a_key_that_cannot_be_is_told_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], keys: tuple[Path, Path]
) -> None:
    key, plant = str(keys[0]), ("--plant", f"pty://{tmp_path}/port")
    assert "cannot read the key none" in refused(capsys, *plant, "--plant-key", "none")
    assert "without --plant" in refused(capsys, "--plant-key", key)
    assert "make its link another one" in refused(capsys, *plant, "--plant-key", key, "--key", key)
    open_door = ("--plant", "udpin://0.0.0.0:0")
    assert "give --plant-key FILE" in refused(capsys, *open_door)


@pytest.mark.parametrize(
    ("text", "mode", "why"),
    [
        ("ab" * 32, 0o644, "others may read the key"),
        ("abcd", 0o600, "it is no key"),
        (None, 0, "No such file"),
    ],
)
def test_the_firmware_refuses_what_is_no_key(
    start: Start, firmware: Path, tmp_path: Path, text: str | None, mode: int, why: str
) -> None:
    if text is not None:
        (tmp_path / "key").write_text(text)
        (tmp_path / "key").chmod(mode)
    robot = start(firmware, "--key", tmp_path / "key", tmp_path / "port")
    _, errors = robot.communicate(timeout=5)
    assert robot.returncode == 2
    assert why in errors
