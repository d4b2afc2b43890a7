"""MAVLink 2 frames, read one at a time.

    FD  length  incompatibility  compatibility  sequence  system  component  id (3)
        payload  crc (2)  [signature (13)]

The payload travels without its trailing zero bytes, but never shorter than one. The CRC is
CRC-16/MCRF4XX from `length` to the end of the payload and one more byte, which every message
definition has of its own (https://mavlink.io/en/guide/serialization.html).
"""

import struct
from enum import Enum, auto
from typing import final

from fastcrc import crc16
from msgspec import Struct

from laglab_protocol.messages.base import Message
from laglab_protocol.messages.layout import LAYOUT_OF_ID

START = 0xFD
HEADER_SIZE = 10
CRC_SIZE = 2
SIGNATURE_SIZE = 13
SIGNED = 0x01
"""The only incompatibility flag that MAVLink 2 defines so far."""

_crc = crc16.mcrf4xx
_unpack_header = struct.Struct("<xBBxBBBI").unpack_from  # one byte beyond the id: masked off


@final
class Frame(Struct, frozen=True, gc=False):
    """A message as it travelled. `raw` is the whole frame, its signature included."""

    message: Message
    system: int
    component: int
    sequence: int
    raw: bytes

    @property
    def signed(self) -> bool:
        """Whether it carries a signature; if a receiver delivered it, one made with our key."""
        return bool(self.raw[2] & SIGNED)


class Refusal(Enum):
    """Why no frame is delivered from a start byte."""

    INCOMPLETE = auto()
    """So far it may be one: more bytes are needed."""
    UNKNOWN = auto()
    """The dialect has no message with this id, so not even the CRC can be checked."""
    INCOMPATIBLE = auto()
    """An incompatibility flag that we do not know: the rest may mean anything."""
    BAD_CRC = auto()
    """Corrupted on its way, from another version of the dialect, or no frame at all."""
    UNSIGNED = auto()
    """A signature is required and there is none."""
    BAD_SIGNATURE = auto()
    """Not signed with our key."""
    NO_KEY = auto()
    """Signed, and we have no key to tell by whom."""
    REPLAYED = auto()
    """Signed with our key, but no later than what this stream has said, or a minute old."""
    AHEAD = auto()
    """Signed with our key, but over a minute ahead of our clock."""
    NESTED = auto()
    """Intact, but inside a frame that was whole and was refused: perhaps its payload."""


def decode(buffer: bytes, start: int, signed_too: bool = True) -> Frame | Refusal:
    """The frame whose start byte is at `start`, its CRC verified, its signature not.

    Unless `signed_too`, a signed one is refused: who has no key cannot tell whose it is.

    Payloads shorter than the message are filled with zeros, longer ones (from a later version of
    the dialect) cut: both as MAVLink 2 demands.
    """
    body = start + HEADER_SIZE
    size = len(buffer)
    if size < body + CRC_SIZE:
        return Refusal.INCOMPLETE
    length, flags, sequence, system, component, number = _unpack_header(buffer, start)
    layout = LAYOUT_OF_ID.get(number & 0xFFFFFF)
    if layout is None:
        return Refusal.UNKNOWN
    if flags and not (flags == SIGNED and signed_too):
        return Refusal.NO_KEY if flags == SIGNED else Refusal.INCOMPATIBLE
    end = body + length
    stop = end + (CRC_SIZE + SIGNATURE_SIZE if flags else CRC_SIZE)
    if size < stop:
        return Refusal.INCOMPLETE
    crc = _crc(buffer[start + 1 : end] + layout.crc_extra)
    if crc != buffer[end] | buffer[end + 1] << 8:
        return Refusal.BAD_CRC
    if length >= layout.size:
        fields = layout.unpack(buffer, body)
    else:
        fields = layout.unpack(buffer[body:end].ljust(layout.size, b"\0"), 0)
    return Frame(layout.type(*fields), system, component, sequence, buffer[start:stop])


def extent(buffer: bytes, start: int) -> int:
    """Where the frame at `start` ends by its header, which must be there whole."""
    signature = SIGNATURE_SIZE if buffer[start + 2] & SIGNED else 0
    return start + HEADER_SIZE + buffer[start + 1] + CRC_SIZE + signature


def is_intact(buffer: bytes, start: int) -> bool:
    """Whether a frame that was refused for something else has the right CRC."""
    layout = LAYOUT_OF_ID.get(int.from_bytes(buffer[start + 7 : start + 10], "little"))
    end = start + HEADER_SIZE + buffer[start + 1]
    if layout is None:
        return False
    return bool(
        _crc(buffer[start + 1 : end] + layout.crc_extra) == buffer[end] | buffer[end + 1] << 8
    )
