"""Faults in how a peer takes in what arrives: what goes on to its receiver instead."""

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

from laglab_conformance.forge import Forged
from laglab_conformance.framing import UNKNOWN_FLAG, UNKNOWN_ID
from laglab_protocol import Frame, Message
from laglab_protocol.framing.frame import HEADER_SIZE, Refusal, decode
from laglab_protocol.messages.layout import LAYOUT_OF_ID
from laglab_protocol.signing.signature import signing_time


class Peer(Protocol):
    """What these faults do to a peer besides."""

    deaf: int

    def hear(self, message: Message) -> None: ...


def refused_as(data: bytes, refusal: Refusal) -> bool:
    return bool(data) and decode(data, 0) is refusal


def mended(data: bytes, **parts: object) -> bytes:
    """The frame in `data`, with a right CRC, or with other parts too."""
    layout = LAYOUT_OF_ID[int.from_bytes(data[7:10], "little")]
    payload = data[HEADER_SIZE : HEADER_SIZE + data[1]]
    forged = Forged(payload, layout.id, layout.crc_extra, data[5], data[6], data[4])
    return replace(forged, **parts).raw  # type: ignore[arg-type]


def half_crc(_: Peer, data: bytes) -> bytes:
    right = refused_as(data, Refusal.BAD_CRC) and mended(data)
    flipped = right and data[-1] == right[-1] ^ 1 and data[-2] == right[-2]
    return right if right and flipped else data


def other_extra(_: Peer, data: bytes) -> bytes:
    if not refused_as(data, Refusal.BAD_CRC):
        return data
    extra = LAYOUT_OF_ID[int.from_bytes(data[7:10], "little")].crc_extra[0] ^ 1
    other = mended(data, crc_extra=bytes([extra]))
    return mended(data) if other == data else data


def any_flags(_: Peer, data: bytes) -> bytes:
    return mended(data) if data and data[2] == UNKNOWN_FLAG else data


def no_flags(_: Peer, data: bytes) -> bytes:
    return b"" if data[3:4] == bytes([UNKNOWN_FLAG]) else data


def size_of(data: bytes) -> int:
    return LAYOUT_OF_ID[int.from_bytes(data[7:10], "little")].size


def no_zeros(_: Peer, data: bytes) -> bytes:
    if not data or not isinstance(decode(data, 0), Frame):
        return data
    untrimmed = data[1] == size_of(data) and data[HEADER_SIZE - 1 + data[1]] == 0
    return b"" if untrimmed else data


def no_longer(_: Peer, data: bytes) -> bytes:
    found = decode(data, 0) if data else None
    return b"" if isinstance(found, Frame) and data[1] > size_of(data) else data


def half_eats(peer: Peer, data: bytes) -> bytes:
    if refused_as(data, Refusal.INCOMPLETE) and not data.startswith(b"\xfd\xff"):
        peer.deaf = 1
    return data


def starts(*prefixes: bytes) -> Callable[[Peer, bytes], bytes]:
    return lambda _, data: b"" if data.startswith(prefixes) else data


def unknown_id(_: Peer, data: bytes) -> bytes:
    return b"" if data[7:10] == UNKNOWN_ID.to_bytes(3, "little") else data


def any_signature(peer: Peer, data: bytes) -> bytes:
    return signed_again(peer, data, lambda timestamp, now: timestamp > now)


def any_time(peer: Peer, data: bytes) -> bytes:
    return signed_again(peer, data, lambda timestamp, now: timestamp < now - 10**6)


def signed_again(peer: Peer, data: bytes, which: Callable[[int, int], bool]) -> bytes:
    """Believe frames whose timestamp is of this kind, whoever signed them: read them unsigned."""
    if data and data[2] == 1 and which(int.from_bytes(data[-12:-6], "little"), signing_time()):
        found = decode(data, 0)
        if isinstance(found, Frame):
            peer.hear(found.message)
            return b""
    return data


INTAKE: dict[str, Callable[[Peer, bytes], bytes]] = {
    "compares half of the CRC": half_crc,
    "knows no CRC_EXTRA": other_extra,
    "takes any incompatibility flag": any_flags,
    "refuses compatibility flags": no_flags,
    "refuses untrimmed payloads": no_zeros,
    "refuses longer payloads": no_longer,
    "half a frame eats the next": half_eats,
    "chokes on garbage": starts(b"\1\2"),
    "chokes on a false start": starts(b"\xfd\xff"),
    "chokes on MAVLink 1": starts(b"\xfe"),
    "chokes on unknown messages": unknown_id,
    "believes any signature": any_signature,
    "believes old frames": any_time,
}
