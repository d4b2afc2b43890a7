"""Frames: what goes in comes out, and pymavlink makes and reads the same bytes."""

import math
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import astuple

from laglab_protocol import (
    DialectError,
    End,
    EndReason,
    Estimate,
    Frame,
    Heartbeat,
    Measurement,
    Message,
    Receiver,
    Sender,
    Tick,
)
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.framing.frame import Refusal, decode
from laglab_protocol.messages.layout import layout_of

from .encoding import encode
from .strategies import messages

POSE = Measurement(1.5, -2.0, math.pi, 0.5, -1.7, 30, 20)


def pymavlink_message(message: Message) -> Any:
    generated = dialect.mavlink_map[layout_of(message).id]
    lists = [list(value) if isinstance(value, tuple) else value for value in astuple(message)]
    values = dict(zip(generated.ordered_fieldnames, lists, strict=True))
    return generated(**values)


@given(messages(), st.integers(0, 255), st.integers(0, 255), st.integers(0, 255))
def test_a_message_comes_back_equal(
    message: Message, system: int, component: int, sequence: int
) -> None:
    raw = encode(message, system, component, sequence)

    assert decode(raw, 0) == Frame(message, system, component, sequence, raw)


@given(messages(), st.integers(0, 255))
def test_pymavlink_makes_the_same_bytes(message: Message, sequence: int) -> None:
    theirs = dialect.MAVLink(None, 1, 190)
    theirs.seq = sequence

    assert pymavlink_message(message).pack(theirs) == encode(message, 1, 190, sequence)


@given(messages())
def test_pymavlink_reads_the_same_fields(message: Message) -> None:
    (read,) = dialect.MAVLink(None).parse_buffer(encode(message, 3, 4, 5))

    expected = pymavlink_message(message)
    assert read.to_dict() == expected.to_dict()
    assert (read.get_srcSystem(), read.get_srcComponent(), read.get_seq()) == (3, 4, 5)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, -0.0])
def test_every_double_travels(value: float) -> None:
    sent = Estimate(*[value] * 9, tick=7)
    (frame,) = Receiver().receive(Sender(1, 1).frame(sent))

    assert struct.pack("<9d", *astuple(frame.message)[:9]) == struct.pack("<9d", *astuple(sent)[:9])


def test_trailing_zeros_stay_at_home() -> None:
    assert len(encode(Tick(300, 0), 1, 1, 0)) == 10 + 2 + 2


def test_an_all_zero_payload_keeps_one_byte() -> None:
    raw = encode(End(0, EndReason.COMPLETED), 1, 1, 0)

    assert raw[1] == 1
    assert decode(raw, 0) == Frame(End(0, 0), 1, 1, 0, raw)


def with_payload(payload: bytes, message_id: int = 52100, flags: int = 0) -> bytes:
    """A frame around any payload, by pymavlink's CRC."""
    body = struct.pack("<BBBBBB", len(payload), flags, 0, 0, 1, 1)
    body += message_id.to_bytes(3, "little") + payload
    extra = dialect.mavlink_map[message_id].crc_extra if message_id in dialect.mavlink_map else 0
    return b"\xfd" + body + struct.pack("<H", dialect.x25crc(body + bytes([extra])).crc)


@pytest.mark.parametrize(
    ("payload", "message"),
    [
        (b"", Tick(0, 0)),
        (b"\x07", Tick(7, 0)),
        (b"\x07\0\0\0\0", Tick(7, 0)),
        (b"\x07\0\0\0\x02", Tick(7, 2)),
        (b"\x07\0\0\0\x02later", Tick(7, 2)),
    ],
)
def test_trimmed_untrimmed_and_longer_payloads_are_read(payload: bytes, message: Tick) -> None:
    (frame,) = Receiver().receive(with_payload(payload))

    assert frame.message == message


def test_an_unknown_compatibility_flag_is_accepted() -> None:
    raw = bytearray(encode(POSE, 1, 1, 0))
    raw[3] = 0x80
    extra = bytes([dialect.mavlink_map[52101].crc_extra])
    raw[-2:] = struct.pack("<H", dialect.x25crc(bytes(raw[1:-2]) + extra).crc)

    assert isinstance(decode(bytes(raw), 0), Frame)


@pytest.mark.parametrize(
    ("raw", "refusal"),
    [
        (with_payload(b"\1", flags=0x02), Refusal.INCOMPATIBLE),
        (with_payload(b"\1", message_id=60000), Refusal.UNKNOWN),
        (encode(POSE, 1, 1, 0)[:-1] + b"\0", Refusal.BAD_CRC),
        (encode(POSE, 1, 1, 0)[:-1], Refusal.INCOMPLETE),
        (b"\xfd", Refusal.INCOMPLETE),
    ],
)
def test_what_is_refused(raw: bytes, refusal: Refusal) -> None:
    assert decode(raw, 0) is refusal


def test_the_sender_counts_modulo_256() -> None:
    sender = Sender(1, 1)
    sequences = [sender.frame(Tick(k, 0))[4] for k in range(258)]

    assert sequences == [*range(256), 0, 1]


def test_a_message_that_does_not_fit_uses_no_sequence_number() -> None:
    sender = Sender(1, 1)
    with pytest.raises(struct.error):
        sender.frame(Tick(-1, 0))
    with pytest.raises(DialectError, match="tuple"):
        sender.frame((1, 2))

    assert sender.frame(Heartbeat(0, 10, 8, 0, 4, 3))[4] == 0
