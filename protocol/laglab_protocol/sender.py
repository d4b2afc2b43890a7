"""One station's voice: it numbers the frames that it makes, and signs them."""

from collections.abc import Callable
from typing import NamedTuple

from laglab_protocol.frame import SIGNED, enclose, header
from laglab_protocol.layout import layout_of
from laglab_protocol.messages import Message
from laglab_protocol.signing import Signer


class Form(NamedTuple):
    """What all the frames of one type from one sender have in common."""

    headers: list[bytes]
    """By sequence number."""
    pack: Callable[..., bytes]
    crc_extra: bytes


class Sender:
    """Makes the frames of one (system, component), signed if there is a signer. No I/O."""

    def __init__(self, system: int, component: int, signer: Signer | None = None) -> None:
        self._system = system
        self._component = component
        self._signer = signer
        self._flags = SIGNED if signer else 0
        self._sequence = 0
        self._forms: dict[type[Message], Form] = {}

    def frame(self, message: Message) -> bytes:
        """The next frame, with `message` in it.

        Raises DialectError for a class that is no message, struct.error for a value out of range;
        neither uses up a sequence number.
        """
        headers, pack, crc_extra = self._forms.get(type(message)) or self._form(message)
        made = enclose(headers[self._sequence] + pack(*message), crc_extra)
        self._sequence = (self._sequence + 1) & 0xFF
        return self._signer.sign(made) if self._signer else made

    def _form(self, message: Message) -> Form:
        layout = layout_of(message)
        headers = [
            header(layout, self._system, self._component, sequence, self._flags)
            for sequence in range(256)
        ]
        form = Form(headers, layout.pack, layout.crc_extra)
        self._forms[type(message)] = form
        return form
