"""Serial ports and ptys, over real pseudo-terminals."""

import os
import termios
import time
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
from laglab_protocol.endpoints.waiting import writable

WAIT = 2.0


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


def test_nor_is_the_link_of_who_still_runs(stack: ExitStack, tmp_path: Path) -> None:
    path = tmp_path / "robot"
    robot = stack.enter_context(open_endpoint(f"pty://{path}"))
    (tmp_path / "here").symlink_to(tmp_path)
    for same in (path, tmp_path / "here" / "robot"):
        with pytest.raises(PortBusyError, match="still runs"):
            open_endpoint(f"pty://{same}")
    station = stack.enter_context(open_endpoint(f"serial://{path}:57600"))
    station.send(b"hello")
    assert robot.receive(WAIT) == b"hello"
    station.close()
    robot.close()
    stack.enter_context(open_endpoint(f"pty://{path}"))


def test_nor_is_a_link_to_one(tmp_path: Path) -> None:
    """But that of an earlier run, whose terminal is gone or another's by now."""
    (tmp_path / "notes").write_text("precious")
    path = tmp_path / "robot"
    for target in (tmp_path / "notes", Path("/dev/ttyUSB0")):
        path.symlink_to(target)
        with pytest.raises(PortBusyError, match="robot"):
            open_endpoint(f"pty://{path}")
        assert path.readlink() == target
        path.unlink()


@pytest.mark.parametrize("scheme", ["pty", "serial"])
def test_what_is_closed_writes_nowhere(stack: ExitStack, tmp_path: Path, scheme: str) -> None:
    """Its descriptor's number goes to the next file that is opened."""
    ends = dict(zip(("pty", "serial"), serial_pair(stack, tmp_path / "robot"), strict=True))
    ends[scheme].close()
    path = tmp_path / "next"
    with path.open("wb"), pytest.raises(FarEndGoneError):
        ends[scheme].send(b"anybody?")
    assert path.read_bytes() == b""


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


def test_what_nobody_reads_is_lost_and_holds_nobody_up(
    stack: ExitStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on any wire; who reads again finds whole frames behind the one that was cut."""
    monkeypatch.setattr(tty, "STALL_TIMEOUT", 0.05)
    robot, station = serial_pair(stack, tmp_path / "robot")
    frames = [bytes([number]) * 1000 for number in range(200)]
    waited: list[bool] = []

    def waiting(descriptor: int, timeout: float) -> bool:
        waited.append(writable(descriptor, timeout))
        return waited[-1]

    monkeypatch.setattr(tty, "writable", waiting)
    for frame in frames:
        robot.send(frame)
    assert waited.count(False) < 5, "once nobody has read for so long, it waits no more"
    with pytest.raises(FarEndStalledError, match="stopped reading"):
        robot.offer(b"anybody?")

    while station.receive(0.05):
        pass
    robot.send(b"again")
    heard = b""
    while data := station.receive(0.05):
        heard += data
    assert heard.endswith(b"again")
    assert len(set(heard.removesuffix(b"again"))) <= 1, "the rest of the frame that was cut"


def test_a_pty_waits_as_long_as_told(stack: ExitStack, tmp_path: Path) -> None:
    robot = stack.enter_context(open_endpoint(f"pty://{tmp_path / 'robot'}"))
    took = []
    for _ in range(3):  # we may be held up once
        started = time.monotonic()
        assert robot.receive(0.05) == b""
        took.append(time.monotonic() - started)

    assert 0.049 < min(took) < 0.5


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
