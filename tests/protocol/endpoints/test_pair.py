"""Two real ptys with a line of 57,600 baud between them."""

import os
import random
import threading
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from laglab_protocol import Endpoint, FarEndGoneError, PortBusyError, SerialPair, open_endpoint
from laglab_protocol.endpoints.wire import TRANSMIT_BUFFER

BAUD = 57600


class Running:
    """A pair that a thread carries bytes for."""

    def __init__(self, folder: Path) -> None:
        self.paths = (folder / "one", folder / "two")
        self.pair = SerialPair(str(self.paths[0]), str(self.paths[1]), BAUD)
        self._ended = False
        self._thread = threading.Thread(target=self._carry)
        self._thread.start()

    def _carry(self) -> None:
        while not self._ended:
            self.pair.carry_once(0.05)

    def open(self, which: int) -> Endpoint:
        return open_endpoint(f"serial://{self.paths[which]}:{BAUD}")

    def close(self) -> None:
        self._ended = True
        self._thread.join()
        self.pair.close()


@pytest.fixture
def running(tmp_path: Path, stack: ExitStack) -> Running:
    made = Running(tmp_path)
    stack.callback(made.close)
    return made


def read_all(endpoint: Endpoint, size: int) -> bytes:
    data = b""
    while len(data) < size:
        piece = endpoint.receive(2.0)
        assert piece, f"only {len(data)} of {size} bytes came"
        data += piece
    return data


def test_both_ways_at_once_each_at_the_baud_rate(running: Running, stack: ExitStack) -> None:
    ends = [stack.enter_context(running.open(which)) for which in (0, 1)]
    sent = [random.Random(which).randbytes(3000) for which in (0, 1)]
    at_the_rate, took = 3000 * 10 / BAUD, list[float]()
    while not took or (took[-1] >= 1.9 * at_the_rate and len(took) < 3):  # we may be held up
        started = time.monotonic()
        for end, data in zip(ends, sent, strict=True):
            end.send(data)
        assert [read_all(ends[1], 3000), read_all(ends[0], 3000)] == sent
        took.append(time.monotonic() - started)
    assert 0.99 * at_the_rate < min(took), "no faster than the line"
    assert took[-1] < 1.9 * at_the_rate, "one after the other takes twice as long"
    running.close()
    assert [way.carried for way in running.pair.lanes] == [3000 * len(took)] * 2


def test_behind_what_crossed_while_the_cable_was_held_up_the_line_is_idle(
    tmp_path: Path, stack: ExitStack
) -> None:
    """What is written then has not begun to cross before."""
    paths = [tmp_path / name for name in ("one", "two")]
    pair = stack.enter_context(SerialPair(*map(str, paths), BAUD))
    writer, reader = (
        stack.enter_context(open_endpoint(f"serial://{path}:{BAUD}")) for path in paths
    )
    writer.send(bytes(100))
    while not pair.lanes[0].wire.next_report():
        pair.carry_once(0.01)
    time.sleep(0.1)
    started, heard = time.monotonic(), 0
    writer.send(bytes(100))
    while heard < 200:
        pair.carry_once(0.01)
        heard += len(reader.receive(0.0))
    assert time.monotonic() - started > 0.99 * 100 * 10 / BAUD


def test_a_writer_faster_than_the_line_has_to_wait(running: Running, stack: ExitStack) -> None:
    """Kernel and line take a bounded amount; the rest goes in only as the line drains."""
    writer, reader = (stack.enter_context(running.open(which)) for which in (0, 1))
    os.set_blocking(writer.fileno(), False)
    taken, started = 0, time.monotonic()
    while time.monotonic() - started < 0.3:
        try:
            taken += os.write(writer.fileno(), bytes(1000))
        except BlockingIOError:
            time.sleep(0.005)
    assert len(read_all(reader, 1000)) >= 1000
    kernel = 70_000
    assert taken < kernel + TRANSMIT_BUFFER + 0.3 * BAUD / 10


def test_a_port_that_nobody_reads_loses_bytes_and_holds_nobody_up(
    tmp_path: Path, stack: ExitStack
) -> None:
    """At a rate that fills the kernel's buffer soon."""
    pair = stack.enter_context(SerialPair(str(tmp_path / "one"), str(tmp_path / "two"), 4_000_000))
    writer = stack.enter_context(open_endpoint(f"serial://{tmp_path / 'one'}:{BAUD}"))
    way, sent, carried = pair.lanes[0], 0, []
    while len(carried) < 100:
        writer.send(bytes(1000))
        sent += 1000
        while way.carried + way.overrun < sent:
            pair.carry_once(0.01)
        if way.overrun:
            carried.append(way.carried)
    assert carried[50] == carried[-1] < 100_000  # the kernel makes some room at first, when it can
    assert way.wire.room == TRANSMIT_BUFFER


def test_ports_are_opened_again(running: Running, stack: ExitStack) -> None:
    other = stack.enter_context(running.open(1))
    for _ in range(2):
        with running.open(0) as port:
            port.send(b"hello")
            assert read_all(other, 5) == b"hello"


def test_a_port_has_one_holder(running: Running, stack: ExitStack) -> None:
    stack.enter_context(running.open(0))
    with pytest.raises(PortBusyError, match="one"):
        running.open(0)


def test_pulling_the_cable_is_noticed_at_both_ports(tmp_path: Path, stack: ExitStack) -> None:
    pair = SerialPair(str(tmp_path / "one"), str(tmp_path / "two"), BAUD)
    ports = [
        stack.enter_context(open_endpoint(f"serial://{tmp_path / name}:{BAUD}"))
        for name in ("one", "two")
    ]
    pair.close()
    for port in ports:
        with pytest.raises(FarEndGoneError, match="gone"):
            port.receive(1.0)
    assert not list(tmp_path.iterdir())


def test_two_ports_need_two_paths(tmp_path: Path) -> None:
    with pytest.raises(PortBusyError, match="two paths"):
        SerialPair(str(tmp_path / "one"), str(tmp_path / "one"), BAUD)
    (tmp_path / "here").symlink_to(tmp_path)
    with pytest.raises(PortBusyError, match="two paths"):
        SerialPair(str(tmp_path / "one"), str(tmp_path / "here" / "one"), BAUD)


def test_the_first_port_goes_when_the_second_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "two").write_text("precious")
    with pytest.raises(PortBusyError, match="two"):
        SerialPair(str(tmp_path / "one"), str(tmp_path / "two"), BAUD)
    assert [path.name for path in tmp_path.iterdir()] == ["two"]
