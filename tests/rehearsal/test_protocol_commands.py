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
    open_endpoint,
)

Laglab = Callable[..., subprocess.CompletedProcess[str]]
Start = Callable[..., "subprocess.Popen[str]"]
ListeningPort = Callable[["subprocess.Popen[str]"], str]

SHORT = ("fig6", "--duration", "0.5")


@pytest.fixture
def key(laglab: Laglab, tmp_path: Path) -> str:
    made = laglab("protocol", "keygen", "station.key")
    assert made.returncode == 0
    assert stat.S_IMODE((tmp_path / "station.key").stat().st_mode) == 0o600
    return "station.key"


def test_a_key_is_never_overwritten(laglab: Laglab, key: str, tmp_path: Path) -> None:
    before = (tmp_path / key).read_text()
    again = laglab("protocol", "keygen", key)
    assert again.returncode == 2
    assert len(again.stderr.splitlines()) == 1
    assert (tmp_path / key).read_text() == before


@pytest.mark.parametrize("transport", ["inline", "udp"])
def test_a_signed_run_gives_the_same_trace(
    laglab: Laglab, key: str, tmp_path: Path, transport: str
) -> None:
    options = (*SHORT, "--transport", transport)
    assert laglab("run", *options, "--out", "open").returncode == 0
    assert laglab("run", *options, "--key", key, "--out", "signed").returncode == 0
    traces = [(tmp_path / name / "trace.csv").read_bytes() for name in ("open", "signed")]
    assert traces[0] == traces[1]


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


def test_a_gateway_that_strangers_can_reach_wants_a_key(laglab: Laglab) -> None:
    refused = laglab("gateway", *SHORT, "--endpoint", "udpin://0.0.0.0:0")
    assert refused.returncode == 2
    assert "--key" in refused.stderr
    assert "Traceback" not in refused.stderr


def test_lint_passes_our_dialect_and_names_the_faults_of_another(
    laglab: Laglab, tmp_path: Path
) -> None:
    assert laglab("protocol", "lint").returncode == 0
    (tmp_path / "bad.xml").write_text(
        '<mavlink><include>common.xml</include><messages><message id="52100" name="lower">'
        '<field type="double" name="from">f</field></message></messages></mavlink>'
    )
    bad = laglab("protocol", "lint", "bad.xml")
    assert bad.returncode == 1
    assert "lower" in bad.stdout
    missing = laglab("protocol", "lint", "none.xml")
    assert (missing.returncode, len(missing.stderr.splitlines())) == (2, 1)


def test_generate_writes_python_that_speaks_our_dialect(laglab: Laglab, tmp_path: Path) -> None:
    assert laglab("protocol", "generate", "--lang", "Python3", "ours").returncode == 0
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


def test_a_controller_has_no_pace_to_test(laglab: Laglab) -> None:
    url = "udpin://127.0.0.1:0"
    result = laglab("conform", url, "--side", "controller", "--pace", "realtime")
    assert result.returncode == 2
    assert "leave --pace out" in result.stderr


@pytest.mark.parametrize("options", [("--pace", "realtime"), ("--side", "controller")])
def test_only_a_robot_in_lock_step_gives_up(laglab: Laglab, options: tuple[str, ...]) -> None:
    url = "udpin://127.0.0.1:0"
    result = laglab("conform", url, "--side", "robot", *options, "--silent")
    assert result.returncode == 2
    assert "--silent is for a robot in lock-step" in result.stderr


def test_the_kit_waits_as_long_as_it_is_told(
    laglab: Laglab, start: Start, listening_port: ListeningPort
) -> None:
    gateway = start("gateway", "fig6", "--silence", "0.5", "--endpoint", "udpin://127.0.0.1:0")
    url = f"udpout://127.0.0.1:{listening_port(gateway)}"
    result = laglab("conform", url, "--side", "robot", "--wait", "3", "--silent")
    assert result.returncode == 0, result.stdout
    assert "it gives up a silent station" in result.stdout
    assert laglab("conform", url, "--side", "robot", "--wait", "0").returncode == 2


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
