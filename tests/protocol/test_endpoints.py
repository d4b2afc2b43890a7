"""Endpoints over real sockets and real pseudo-terminals."""

import os
import termios
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab_protocol import (
    Endpoint,
    FarEndGoneError,
    FarEndStalledError,
    NoSuchPortError,
    PortBusyError,
    open_endpoint,
)
from laglab_protocol.endpoints import tty

WAIT = 2.0


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as opened:
        yield opened


def udp_pair(stack: ExitStack) -> tuple[Endpoint, Endpoint]:
    robot = stack.enter_context(open_endpoint("udpin://127.0.0.1:0"))
    station = stack.enter_context(open_endpoint(robot.name.replace("udpin", "udpout")))
    return robot, station


def serial_pair(stack: ExitStack, path: Path) -> tuple[Endpoint, Endpoint]:
    robot = stack.enter_context(open_endpoint(f"pty://{path}"))
    station = stack.enter_context(open_endpoint(f"serial://{path}:57600"))
    return robot, station


def read_all(endpoint: Endpoint, size: int) -> bytes:
    data = b""
    while len(data) < size:
        piece = endpoint.receive(WAIT)
        assert piece, f"only {len(data)} of {size} bytes came"
        data += piece
    return data


# UDP


def test_udp_both_ways(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    station.send(b"hello")
    assert robot.receive(WAIT) == b"hello"
    robot.accept_peer()
    robot.send(b"welcome")

    assert station.receive(WAIT) == b"welcome"
    assert robot.datagrams
    assert robot.loopback


def test_udpin_without_a_peer_drops(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    robot.send(b"to nobody")
    station.send(b"not accepted")
    robot.receive(WAIT)
    robot.send(b"to nobody")

    assert station.receive(0.02) == b""


def test_a_stranger_does_not_take_the_link(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    stranger = stack.enter_context(open_endpoint(station.name))
    station.send(b"mine")
    robot.receive(WAIT)
    robot.accept_peer()
    stranger.send(b"garbage")
    robot.receive(WAIT)
    robot.send(b"answer")

    assert station.receive(WAIT) == b"answer"
    assert stranger.receive(0.02) == b""


def test_a_later_accepted_peer_replaces_the_first(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    again = stack.enter_context(open_endpoint(station.name))
    for peer in (station, again):
        peer.send(b"hello")
        robot.receive(WAIT)
        robot.accept_peer()
    robot.send(b"answer")

    assert again.receive(WAIT) == b"answer"
    assert station.receive(0.02) == b""


def test_beside_a_peer_that_was_left_nobody_is_a_stranger(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    others = [stack.enter_context(open_endpoint(station.name)) for _ in range(2)]
    station.send(b"hello")
    robot.receive(WAIT)
    robot.accept_peer()
    robot.leave_peer()
    robot.send(b"to nobody")
    for _ in range(20):
        others[0].send(bytes(1400))  # strangers' ration of three seconds
    others[1].send(b"now me")
    heard = [robot.receive(WAIT) for _ in range(21)]
    assert heard[-1] == b"now me"
    robot.accept_peer()
    robot.send(b"answer")
    assert others[1].receive(WAIT) == b"answer"
    assert station.receive(0.02) == b""


def test_udpout_before_anybody_listens(stack: ExitStack) -> None:
    with open_endpoint("udpin:127.0.0.1:0") as taken:
        name = taken.name
    station = stack.enter_context(open_endpoint(name.replace("udpin", "udpout")))
    started = time.monotonic()
    for _ in range(3):
        station.send(b"anybody?")
        assert station.receive(0.1) == b""
    assert time.monotonic() - started >= 0.25

    robot = stack.enter_context(open_endpoint(name))
    station.send(b"now?")
    assert robot.receive(WAIT) == b"now?"


@pytest.mark.parametrize("timeout", [0.0, 0.01, 0.2])
def test_udp_waits_as_long_as_told(stack: ExitStack, timeout: float) -> None:
    robot, station = udp_pair(stack)
    for endpoint in (robot, station):
        started = time.monotonic()
        assert endpoint.receive(timeout) == b""
        assert timeout <= time.monotonic() - started + 0.001 < timeout + 0.5


def test_udpin_binds_loopback_unless_told_otherwise(stack: ExitStack) -> None:
    assert stack.enter_context(open_endpoint("udpin://:0")).name.startswith("udpin://127.0.0.1:")
    assert not stack.enter_context(open_endpoint("udpin://0.0.0.0:0")).loopback


def test_an_empty_datagram_is_nothing(stack: ExitStack) -> None:
    robot, station = udp_pair(stack)
    station.send(b"")

    assert robot.receive(WAIT) == b""


# Serial and pty


def test_serial_both_ways_with_every_byte(stack: ExitStack, tmp_path: Path) -> None:
    robot, station = serial_pair(stack, tmp_path / "robot")
    every = bytes(range(256))
    robot.send(every)
    assert read_all(station, 256) == every
    station.send(every)

    assert read_all(robot, 256) == every
    assert not robot.datagrams


def test_the_other_serial_spelling(stack: ExitStack, tmp_path: Path) -> None:
    path = tmp_path / "robot"
    robot = stack.enter_context(open_endpoint(f"pty://{path}"))
    station = stack.enter_context(open_endpoint(f"{path},57600"))
    station.send(b"hello")

    assert station.name == f"serial://{path}:57600"
    assert robot.receive(WAIT) == b"hello"


def test_a_pty_is_raw_before_anybody_opens_it(stack: ExitStack, tmp_path: Path) -> None:
    robot = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'robot'}"))
    robot.send(b"early\n")
    far = os.open(tmp_path / "robot", os.O_RDWR | os.O_NOCTTY)
    stack.callback(os.close, far)

    assert os.read(far, 100) == b"early\n"
    assert not termios.tcgetattr(far)[3] & termios.ECHO
    assert robot.receive(0.02) == b""


def test_a_pty_is_reopened_as_a_port_is(stack: ExitStack, tmp_path: Path) -> None:
    robot = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'robot'}"))
    for _ in range(2):
        with open_endpoint(f"serial://{tmp_path / 'robot'}:57600") as station:
            station.send(b"hello")
            assert robot.receive(WAIT) == b"hello"
    assert robot.receive(0.02) == b""


def test_closing_removes_the_link(tmp_path: Path) -> None:
    path = tmp_path / "robot"
    with open_endpoint(f"pty://{path}") as robot:
        assert path.is_symlink()
    robot.close()

    assert not path.is_symlink()


def test_a_stale_link_is_replaced(stack: ExitStack, tmp_path: Path) -> None:
    path = tmp_path / "robot"
    path.symlink_to("/dev/pts/99999")
    stack.enter_context(open_endpoint(f"pty://{path}"))

    assert path.exists()


def test_closing_leaves_another_s_link(tmp_path: Path) -> None:
    path = tmp_path / "robot"
    with open_endpoint(f"pty://{path}"):
        path.unlink()
        path.symlink_to("/dev/null")

    assert str(path.readlink()) == "/dev/null"


def test_a_file_is_not_replaced(tmp_path: Path) -> None:
    path = tmp_path / "robot"
    path.write_text("precious")
    with pytest.raises(PortBusyError, match="robot"):
        open_endpoint(f"pty://{path}")

    assert path.read_text() == "precious"


def test_a_second_reader_is_refused(stack: ExitStack, tmp_path: Path) -> None:
    serial_pair(stack, tmp_path / "robot")

    with pytest.raises(PortBusyError, match="another program"):
        open_endpoint(f"serial://{tmp_path / 'robot'}:57600")


def test_an_unplugged_port_says_so(stack: ExitStack, tmp_path: Path) -> None:
    robot, station = serial_pair(stack, tmp_path / "robot")
    robot.close()

    with pytest.raises(FarEndGoneError, match="robot"):
        station.receive(WAIT)
    with pytest.raises(FarEndGoneError, match="robot"):
        station.send(b"anybody?")


def test_a_port_that_does_not_come_back_writes_nowhere(stack: ExitStack, tmp_path: Path) -> None:
    """Its descriptor's number goes to the next file that is opened."""
    robot, station = serial_pair(stack, tmp_path / "robot")
    robot.close()
    with pytest.raises(NoSuchPortError):
        station.reopen()
    others = [tmp_path / name for name in ("one", "two", "three")]
    for path in others:
        stack.enter_context(path.open("wb"))
    with pytest.raises(FarEndGoneError):
        station.send(b"anybody?")
    assert [path.read_bytes() for path in others] == [b"", b"", b""]


def test_a_reader_that_stopped_is_noticed(
    stack: ExitStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tty, "STALL_TIMEOUT", 0.05)
    robot = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'robot'}"))

    with pytest.raises(FarEndStalledError, match="stopped reading"):
        robot.send(bytes(1_000_000))


def test_a_pty_waits_as_long_as_told(stack: ExitStack, tmp_path: Path) -> None:
    robot = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'robot'}"))
    started = time.monotonic()

    assert robot.receive(0.05) == b""
    assert 0.049 < time.monotonic() - started < 0.5


def test_a_refusal_that_comes_late_does_not_keep_the_processor_busy(stack: ExitStack) -> None:
    """Over a network it comes after the first wait; the descriptor wakes, and there is nothing."""
    with open_endpoint("udpin://:0") as nobody:
        url = nobody.name.replace("udpin", "udpout")
    station = stack.enter_context(open_endpoint(url))
    later = threading.Timer(0.02, station.send, [b"x"])
    later.start()
    busy = time.thread_time()
    assert station.receive(0.4) == b""
    assert time.thread_time() - busy < 0.1
    later.join()


@pytest.mark.parametrize("vmin", [0, 1])
def test_silence_on_a_serial_port_is_not_hanging_up(
    stack: ExitStack, tmp_path: Path, vmin: int
) -> None:
    """Whatever another program has made of the port: with VMIN 0 a read gives no bytes at once."""
    robot = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'tty'}"))
    station = stack.enter_context(open_endpoint(f"serial://{tmp_path / 'tty'}:57600"))
    attributes = termios.tcgetattr(station.fileno())
    attributes[6][termios.VMIN] = vmin
    termios.tcsetattr(station.fileno(), termios.TCSANOW, attributes)
    assert station.receive(0.01) == b""
    robot.close()
    with pytest.raises(FarEndGoneError):
        station.receive(0.1)
