"""One station's voice: it numbers the frames that it makes, and signs them."""

import struct
from collections.abc import Callable

from fastcrc import crc16
from msgspec.structs import astuple

from laglab_protocol.framing.frame import SIGNED, START
from laglab_protocol.messages.base import Message
from laglab_protocol.messages.layout import layout_of
from laglab_protocol.signing.signature import Signer

_crc = crc16.mcrf4xx
_SHORTEST_BODY = 9
"""From the third byte of a frame to the end of a payload of one byte."""
_OPENINGS = {
    length + 8: (bytes([START, length]), _crc(bytes([length]))) for length in range(1, 256)
}
"""By the length of that body: the first two bytes of the frame, and the CRC of the second."""
_pack_header = struct.Struct("<BBBBB3s").pack

Form = tuple[list[bytes], Callable[..., bytes], bytes]
"""What all the frames of one type from one sender have in common: by sequence number what stands
between length and payload, the packing of the fields, the CRC's extra byte."""


class Sender:
    """Makes the frames of one (system, component), signed if there is a signer. No I/O."""

    def __init__(self, system: int, component: int, signer: Signer | None = None) -> None:
        self._system = system
        self._component = component
        self._signer = signer
        self._sequence = 0
        self._forms: dict[type[Message], Form] = {}

    def sibling(self) -> "Sender":
        """The same speaker to somebody else, who is to see no gaps in the numbers."""
        return Sender(self._system, self._component, self._signer)

    def frame(self, message: Message) -> bytes:
        """The next frame, with `message` in it.

        Raises DialectError for a class that is no message, struct.error for a value out of range;
        neither uses up a sequence number.
        """
        headers, pack, crc_extra = self._forms.get(type(message)) or self._form(message)
        body = headers[self._sequence] + pack(*astuple(message))
        body = body.rstrip(b"\0").ljust(_SHORTEST_BODY, b"\0")
        opening, crc = _OPENINGS[len(body)]
        crc = _crc(body + crc_extra, crc)
        self._sequence = (self._sequence + 1) & 0xFF
        if self._signer is None:
            return opening + body + crc.to_bytes(2, "little")
        return self._signer.sign(opening + body, crc)

    def _form(self, message: Message) -> Form:
        layout = layout_of(message)
        flags = SIGNED if self._signer else 0
        headers = [
            _pack_header(flags, 0, sequence, self._system, self._component, layout.id_bytes)
            for sequence in range(256)
        ]
        form = self._forms[type(message)] = headers, layout.pack, layout.crc_extra
        return form
