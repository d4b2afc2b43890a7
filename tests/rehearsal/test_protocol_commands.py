"""Signing, lint, generated code and the conformance kit, as commands."""

import stat
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from pymavlink import mavutil

from laglab.runs.robot_side import shown_parameters
from laglab.scenario import Scenario
from laglab_protocol import (
    CommandLong,
    Endpoint,
    Heartbeat,
    LocalPositionNed,
    Receiver,
    Sender,
    make_key,
    open_endpoint,
)

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Ended = Callable[..., Any]
Refused = Callable[..., str]
Start = Callable[..., "subprocess.Popen[str]"]
ListeningPort = Callable[["subprocess.Popen[str]"], str]

SHORT = ("fig6", "--duration", "0.5")


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def key(tmp_path: Path) -> str:
    make_key(tmp_path / "station.key")
    return "station.key"


def test_a_key_is_for_its_owner_and_never_overwritten(
    ended: Ended, refused: Refused, tmp_path: Path
) -> None:
    made = tmp_path / "made.key"
    assert ended("protocol", "keygen", "made.key").code == 0
    assert stat.S_IMODE(made.stat().st_mode) == 0o600
    before = made.read_text()
    assert "made.key" in refused("protocol", "keygen", "made.key")
    assert made.read_text() == before


def test_a_signed_run_gives_the_same_trace(ended: Ended, key: str, tmp_path: Path) -> None:
    signed = ("--key", key)
    for name, options in (
        ("open", ("--transport", "inline")),
        ("inline", ("--transport", "inline", *signed)),
        ("udp", ("--transport", "udp", *signed)),
    ):
        assert ended("run", *SHORT, *options, "--out", name).code == 0
    traces = {(tmp_path / name / "trace.csv").read_bytes() for name in ("open", "inline", "udp")}
    assert len(traces) == 1


def test_a_station_without_the_key_does_not_move_the_robot(
    start: Start, listening_port: ListeningPort, key: str, tmp_path: Path
) -> None:
    gateway = start(
        "gateway", *SHORT, "--endpoint", "udpin://127.0.0.1:0", "--key", key, "--out", "run"
    )
    link = ("--endpoint", f"udpout://127.0.0.1:{listening_port(gateway)}")
    stranger = start("controller", *SHORT, *link)
    with pytest.raises(subprocess.TimeoutExpired):
        gateway.wait(4)
    assert (tmp_path / "run" / "trace.csv").read_text().count("\n") == 1
    stranger.kill()
    start("controller", *SHORT, *link, "--key", key)
    assert gateway.wait(20) == 0


def test_a_gateway_that_strangers_can_reach_wants_a_key(refused: Refused) -> None:
    assert "--key" in refused("gateway", *SHORT, "--endpoint", "udpin://0.0.0.0:0")


def test_lint_passes_our_dialect_and_names_the_faults_of_another(
    ended: Ended, refused: Refused, tmp_path: Path
) -> None:
    assert ended("protocol", "lint").code == 0
    (tmp_path / "bad.xml").write_text(
        '<mavlink><include>common.xml</include><messages><message id="52100" name="lower">'
        '<field type="double" name="from">f</field></message></messages></mavlink>'
    )
    bad = ended("protocol", "lint", "bad.xml")
    assert bad.code == 1
    assert "lower" in bad.out
    assert "none.xml" in refused("protocol", "lint", "none.xml")


def test_generate_writes_python_that_speaks_our_dialect(ended: Ended, tmp_path: Path) -> None:
    assert ended("protocol", "generate", "--lang", "Python3", "ours").code == 0
    program = "import laglab; print(laglab.MAVLink_laglab_tick_message.id)"
    where = tmp_path / "ours"
    said = subprocess.check_output([sys.executable, "-c", program], cwd=where, text=True)
    assert said.strip() == "52100"


@pytest.mark.slow
def test_our_robot_conforms(
    laglab: Laglab, start: Start, listening_port: ListeningPort, tmp_path: Path
) -> None:
    options = ("--duration", "3600", "--silence", "30")
    gateway = start("gateway", "fig6", *options, "--endpoint", "udpin://127.0.0.1:0")
    url = f"udpout://127.0.0.1:{listening_port(gateway)}"
    result = laglab("conform", url, "--side", "robot", "--junit", "robot.xml")
    assert result.returncode == 0, result.stdout
    assert "the robot conforms" in result.stdout
    suite = ElementTree.parse(tmp_path / "robot.xml").getroot()
    assert suite.get("failures") == "0"


@pytest.mark.slow
def test_nobody_there_does_not_conform(laglab: Laglab) -> None:
    result = laglab("conform", "udpout://127.0.0.1:9", "--side", "robot")
    assert result.returncode == 1
    assert "does not conform" in result.stdout


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--side", "controller", "--pace", "realtime"), "leave --pace out"),
        (("--side", "robot", "--pace", "realtime", "--silent"), "is for a robot in lock-step"),
        (("--side", "controller", "--silent"), "--silent is for a robot in lock-step"),
    ],
)
def test_only_a_robot_has_a_pace_and_one_in_lock_step_gives_up(
    refused: Refused, options: tuple[str, ...], said: str
) -> None:
    assert said in refused("conform", "udpin://127.0.0.1:0", *options)


def test_the_kit_waits_as_long_as_it_is_told(
    ended: Ended, start: Start, listening_port: ListeningPort
) -> None:
    gateway = start("gateway", "fig6", "--silence", "0.5", "--endpoint", "udpin://127.0.0.1:0")
    url = f"udpout://127.0.0.1:{listening_port(gateway)}"
    result = ended("conform", url, "--side", "robot", "--wait", "3", "--silent")
    assert result.code == 0, result.out
    assert "it gives up a silent station" in result.out
    assert ended("conform", url, "--side", "robot", "--wait", "0").code == 2


def test_a_ground_station_reads_the_gains_and_the_noise() -> None:
    shown = shown_parameters(Scenario(noise=True))

    assert (shown["DELAY_N"], shown["DELAY_M"]) == (10, 20)
    assert (shown["LAW_GAMMA"], shown["LAW_LAMBDA"], shown["LAW_H"]) == (3.0, 6.0, 1.0)
    assert (shown["NOISE_X"], shown["NOISE_THETA"], shown["NOISE_WHEEL"]) == (0.01, 0.018, 0.01)
    assert shown_parameters(Scenario(noise=False))["NOISE_X"] == 0.0


def test_a_disarmed_robot_moves_when_a_ground_station_arms_it(
    start: Start, listening_port: ListeningPort
) -> None:
    options = ("--pace", "realtime", "--disarmed", "--watch", "udpin://127.0.0.1:0")
    gateway = start("gateway", "fig4", *options, "--endpoint", "udpin://127.0.0.1:0")
    port, watched = listening_port(gateway), listening_port(gateway)
    assert gateway.stderr is not None
    assert "stands still until a ground station arms it" in gateway.stderr.readline()
    start("controller", "fig4", "--endpoint", f"udpout://127.0.0.1:{port}")
    sender, receiver = Sender(255, 190), Receiver()

    def position(link: Endpoint) -> tuple[float, float]:
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline:
            link.send(sender.frame(Heartbeat(0, 6, 8, 0, 4, 3)))
            for frame in receiver.receive(link.receive(0.2), whole=True):
                if isinstance(frame.message, LocalPositionNed):
                    return frame.message.x, frame.message.y
        raise AssertionError("the robot tells no position")

    with open_endpoint(f"udpout://127.0.0.1:{watched}") as link:
        assert {position(link) for _ in range(5)} == {(-3.0, -3.0)}
        link.send(sender.frame(CommandLong(1.0, 0, 0, 0, 0, 0, 0, 400, 1, 1, 0)))
        deadline = time.monotonic() + 20
        while position(link) == (-3.0, -3.0):
            assert time.monotonic() < deadline, "armed, but it does not move"


def ground_station(port: str, key: bytes | None) -> Any:
    """pymavlink's own, which signs with a key; it has said that it is there."""
    link: Any = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}", source_system=255)
    if key:
        link.setup_signing(key)
    link.mav.heartbeat_send(6, 8, 0, 0, 4)
    return link


@pytest.mark.parametrize(
    ("options", "signs", "seen"),
    [
        (("--key",), True, True),
        (("--key",), False, False),
        (("--unsigned", "--key"), False, True),
        (("--unsigned", "--key"), True, True),
    ],
    ids=[
        "signed",
        "without the key",
        "without the key, in so many words",
        "signed, though it need not be",
    ],
)
def test_with_a_key_watchers_need_it_too(
    start: Start,
    listening_port: ListeningPort,
    key: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    options: tuple[str, ...],
    signs: bool,
    seen: bool,
) -> None:
    monkeypatch.setenv("MAVLINK20", "1")
    mavutil.set_dialect("common")
    urls = ("--watch", "udpin://127.0.0.1:0", "--endpoint", "udpin://127.0.0.1:0")
    gateway = start("gateway", "fig4", *urls, *options, key)
    _, watched = listening_port(gateway), listening_port(gateway)
    secret = bytes.fromhex((tmp_path / key).read_text()) if signs else None
    with closing(ground_station(watched, secret)) as link:
        link.mav.command_long_send(1, 1, 400, 0, 1.0, 0, 0, 0, 0, 0, 0)
        ack = link.recv_match(type="COMMAND_ACK", blocking=True, timeout=5.0 if seen else 1.0)

    assert (ack is not None) == seen
    if ack is not None:
        assert ack.get_msgbuf()[2] == 1  # signed, whether the ground station can tell or not
