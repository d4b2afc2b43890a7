"""How each message lies in its payload, taken from the classes that mavgen generated."""

import struct
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.errors import DialectError
from laglab_protocol.messages.base import Message
from laglab_protocol.messages.names import message_type


@dataclass(frozen=True, slots=True)
class Layout:
    """One message, and how its fields lie on the wire.

    `pack(*fields)` gives the payload, untruncated; `unpack(buffer, start)` reads the fields from
    the `size` bytes of one.
    """

    id: int
    name: str
    type: type[Message]
    size: int
    crc_extra: bytes
    id_bytes: bytes
    pack: Callable[..., bytes]
    unpack: Callable[[bytes, int], Iterable[Any]]


def _layout(number: int) -> Layout:
    generated = dialect.mavlink_map[number]
    kind = message_type(generated.msgname)
    fields: struct.Struct = generated.unpacker
    lengths: list[int] = generated.array_lengths  # in wire order; 0 for a scalar
    return Layout(
        id=number,
        name=generated.msgname,
        type=kind,
        size=fields.size,
        crc_extra=bytes([generated.crc_extra]),
        id_bytes=number.to_bytes(3, "little"),
        pack=partial(_pack_arrays, fields) if any(lengths) else fields.pack,
        unpack=partial(_unpack_arrays, fields, lengths) if any(lengths) else fields.unpack_from,
    )


def _pack_arrays(fields: struct.Struct, *values: Any) -> bytes:
    flat: list[Any] = []
    for value in values:
        if isinstance(value, tuple | list):
            flat.extend(value)
        else:
            flat.append(value)
    return fields.pack(*flat)


def _unpack_arrays(
    fields: struct.Struct, lengths: list[int], buffer: bytes, start: int
) -> Iterator[Any]:
    return _grouped(iter(fields.unpack_from(buffer, start)), lengths)


def _grouped(values: Iterator[Any], lengths: list[int]) -> Iterator[Any]:
    """Texts lose the zero bytes that pad them, the elements of an array become one tuple."""
    for length in lengths:
        value = next(values)
        if isinstance(value, bytes):
            yield value.rstrip(b"\0") if length else value
        elif length > 1:
            yield (value, *(next(values) for _ in range(length - 1)))
        else:
            yield value


LAYOUT_OF_ID: dict[int, Layout] = {number: _layout(number) for number in dialect.mavlink_map}
LAYOUT_OF_TYPE: dict[type[Message], Layout] = {each.type: each for each in LAYOUT_OF_ID.values()}


def layout_of(message: Message) -> Layout:
    """The layout of `message`. Raises DialectError when its class is none of the dialect's."""
    found = LAYOUT_OF_TYPE.get(type(message))
    if found is None:
        raise DialectError(
            f"{type(message).__name__} is no message: use the classes of laglab_protocol"
        )
    return found
