"""Other people's parsers in the place of our receiver."""

import ctypes
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

from laglab.c_library import c_library, new_folder
from laglab_protocol import LAYOUT_OF_ID, Frame, Message, Receiver, message_type
from laglab_protocol.dialect.generated import laglab as pymavlink
from laglab_protocol.dialect.mavgen import dialect_path, generate

CHECKED = frozenset(layout.name for layout in LAYOUT_OF_ID.values())
"""pymavlink also gives bad data, and unknown messages with any CRC, by other names."""
READER = Path(__file__).with_name("reader.c")


class PymavlinkReceiver(Receiver):
    """pymavlink's, as its mavutil uses it: one parser for all datagrams."""

    def __init__(self, _: ExitStack) -> None:
        super().__init__()
        self._parser = pymavlink.MAVLink(None)
        self._parser.robust_parsing = True

    def receive(self, data: bytes, whole: bool = False) -> list[Frame]:
        del whole
        read = self._parser.parse_buffer(data) or []
        return [_frame(each) for each in read if each.get_type() in CHECKED]


def _frame(read: pymavlink.MAVLink_message) -> Frame:
    source = read.get_srcSystem(), read.get_srcComponent(), read.get_seq()
    return Frame(message_of(read.get_type(), read.to_dict()), *source, bytes(read.get_msgbuf()))


def message_of(name: str, fields: dict[str, object]) -> Message:
    """Our message with these fields."""
    kind = message_type(name)
    return kind(**{field: _value(fields[field]) for field in kind.__struct_fields__})


def _value(value: object) -> object:
    """Texts are bytes, and arrays tuples, in ours."""
    if isinstance(value, str):
        return value.encode()
    return tuple(value) if isinstance(value, list) else value


class CReceiver(Receiver):
    """mavgen's C, as its examples use it: `mavlink_parse_char` and nothing else."""

    def __init__(self, stack: ExitStack) -> None:
        """Raises BuildError and CompilerNotFoundError."""
        super().__init__()
        headers = new_folder(stack)
        generate(dialect_path(), "C", headers)
        self._library = c_library(READER, {}, stack, headers)
        self._library.payload.restype = ctypes.c_void_p

    def receive(self, data: bytes, whole: bool = False) -> list[Frame]:
        del whole
        return list(self._read(data))

    def _read(self, data: bytes) -> Iterator[Frame]:
        library = self._library
        for byte in data:
            if library.take(byte) and (layout := LAYOUT_OF_ID.get(library.message_id())):
                payload = ctypes.string_at(library.payload(), layout.size)
                source = library.system_id(), library.component_id(), library.sequence()
                yield Frame(layout.type(*layout.unpack(payload, 0)), *source, b"")
