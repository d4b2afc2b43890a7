"""The golden table in our codec and in pymavlink; other files hold it to C, libmav and tshark."""

import struct
from typing import Any

import pytest
from msgspec.structs import astuple

from laglab_protocol import Message
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.framing.frame import Frame, decode
from laglab_protocol.messages.layout import layout_of

from .encoding import encode
from .golden import GOLDEN, Golden, numbers

rows = pytest.mark.parametrize("row", GOLDEN, ids=lambda row: row.name)


def bits(message: Message) -> bytes:
    """The fields as bytes, so that a NaN equals itself and zeros keep their sign."""
    return b"".join(struct.pack("<d", each) for each in numbers(message))


@rows
def test_we_make_these_bytes(row: Golden) -> None:
    assert encode(row.message, row.system, row.component, row.sequence) == row.raw


@rows
def test_we_read_these_fields(row: Golden) -> None:
    frame = decode(row.raw, 0)

    assert isinstance(frame, Frame)
    assert type(frame.message) is type(row.message)
    assert bits(frame.message) == bits(row.message)
    assert astuple(frame)[1:] == (row.system, row.component, row.sequence, row.raw)


def generated_of(message: Message) -> Any:
    return dialect.mavlink_map[layout_of(message).id]


@rows
def test_pymavlink_makes_these_bytes(row: Golden) -> None:
    theirs = dialect.MAVLink(None, row.system, row.component)
    theirs.seq = row.sequence
    generated = generated_of(row.message)
    fields = dict(zip(generated.ordered_fieldnames, astuple(row.message), strict=True))

    assert generated(**fields).pack(theirs) == row.raw


@rows
def test_pymavlink_reads_these_fields(row: Golden) -> None:
    (read,) = dialect.MAVLink(None).parse_buffer(row.raw)
    fields = [getattr(read, name) for name in generated_of(row.message).ordered_fieldnames]
    fields = [tuple(each) if isinstance(each, list) else each for each in fields]

    assert bits(type(row.message)(*fields)) == bits(row.message)


def test_every_message_of_ours_is_in_the_table() -> None:
    ours = {number for number in dialect.mavlink_map if number >= 52100}

    assert ours <= {layout_of(row.message).id for row in GOLDEN}


@rows
def test_another_definition_of_the_message_is_noticed(row: Golden) -> None:
    """CRC_EXTRA is in the CRC: bytes from a changed dialect are refused, not misread."""
    body, extra = row.raw[1:-2], generated_of(row.message).crc_extra ^ 1
    other = b"\xfd" + body + struct.pack("<H", dialect.x25crc(body + bytes([extra])).crc)

    assert not isinstance(decode(other, 0), Frame)
