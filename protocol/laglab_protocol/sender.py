"""One station's voice: it numbers the frames that it makes, and signs them."""

from collections.abc import Callable

from msgspec.structs import astuple

from laglab_protocol.frame import SIGNED, enclose, header
from laglab_protocol.layout import layout_of
from laglab_protocol.message import Message
from laglab_protocol.signing import Signer

Form = tuple[list[bytes], Callable[..., bytes], bytes]
"""What all the frames of one type from one sender have in common: headers by sequence number,
the packing of the fields, the CRC's extra byte."""


class Sender:
    """Makes the frames of one (system, component), signed if there is a signer. No I/O."""

    def __init__(self, system: int, component: int, signer: Signer | None = None) -> None:
        self._system = system
        self._component = component
        self._signer = signer
        self._sequence = 0
        self._forms: dict[type[Message], Form] = {}

    def frame(self, message: Message) -> bytes:
        """The next frame, with `message` in it.

        Raises DialectError for a class that is no message, struct.error for a value out of range;
        neither uses up a sequence number.
        """
        headers, pack, crc_extra = self._forms.get(type(message)) or self._form(message)
        made, crc = enclose(headers[self._sequence] + pack(*astuple(message)), crc_extra)
        self._sequence = (self._sequence + 1) & 0xFF
        return self._signer.sign(made, crc) if self._signer else made + crc.to_bytes(2, "little")

    def _form(self, message: Message) -> Form:
        layout = layout_of(message)
        flags = SIGNED if self._signer else 0
        headers = [
            header(layout, self._system, self._component, sequence, flags)
            for sequence in range(256)
        ]
        form = self._forms[type(message)] = headers, layout.pack, layout.crc_extra
        return form
