"""The pace of a serial line, on a clock of the test's own."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_protocol.endpoints.wire import FIFO, TRANSMIT_BUFFER, Wire

BAUD = 57600
BYTE = 10 / BAUD


def test_a_byte_takes_ten_bits() -> None:
    wire = Wire(BAUD)
    wire.put(b"ab", 5.0)
    assert wire.take(5.0 + 0.9 * BYTE) == b""
    assert wire.take(5.0 + BYTE) == b"a"
    assert wire.take(5.0 + 2 * BYTE) == b"b"
    assert wire.next_report() is None


def test_a_line_that_was_idle_starts_anew() -> None:
    wire = Wire(BAUD)
    wire.put(b"a", 0.0)
    wire.take(10.0)
    wire.put(b"b", 20.0)
    assert wire.take(20.0 + 0.9 * BYTE) == b""
    assert wire.take(20.0 + BYTE) == b"b"


def test_what_is_put_while_it_sends_waits_its_turn() -> None:
    wire = Wire(BAUD)
    wire.put(b"a", 0.0)
    wire.put(b"b", 0.5 * BYTE)
    assert wire.take(1.9 * BYTE) == b"a"
    assert wire.take(2 * BYTE) == b"b"


def test_it_reports_at_a_full_fifo_and_at_the_last_byte() -> None:
    wire = Wire(BAUD)
    wire.put(bytes(FIFO + 4), 1.0)
    assert wire.next_report() == pytest.approx(1.0 + FIFO * BYTE)
    assert len(wire.take(1.0 + FIFO * BYTE)) == FIFO
    assert wire.next_report() == pytest.approx(1.0 + (FIFO + 4) * BYTE)


@given(
    steps=st.lists(st.tuples(st.binary(max_size=600), st.floats(0, 0.05)), max_size=60),
    baud=st.sampled_from([300, 9600, BAUD, 1_000_000]),
)
def test_every_byte_crosses_in_order_never_faster_than_the_line(
    steps: list[tuple[bytes, float]], baud: int
) -> None:
    wire, now, sent, came = Wire(baud), 100.0, b"", b""
    for data, pause in steps:
        accepted = data[: wire.room]
        wire.put(accepted, now)
        sent += accepted
        now += pause
        came += wire.take(now)
        assert len(came) <= (now - 100.0) * baud / 10 + 1
        assert 0 <= wire.room <= TRANSMIT_BUFFER
        assert sent.startswith(came)
    came += wire.take(now + TRANSMIT_BUFFER * 10 / baud + 1e-3)
    assert came == sent
    assert wire.room == TRANSMIT_BUFFER
