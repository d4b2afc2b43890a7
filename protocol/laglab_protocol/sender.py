"""One station's voice: it numbers the frames that it makes, and signs them."""

from laglab_protocol.frame import SIGNED, encode
from laglab_protocol.messages import Message
from laglab_protocol.signing import Signer


class Sender:
    """Makes the frames of one (system, component), signed if there is a signer. No I/O."""

    def __init__(self, system: int, component: int, signer: Signer | None = None) -> None:
        self._system = system
        self._component = component
        self._signer = signer
        self._flags = SIGNED if signer else 0
        self._sequence = 0

    def frame(self, message: Message) -> bytes:
        """The next frame, with `message` in it.

        Raises DialectError for a class that is no message, struct.error for a value out of range;
        neither uses up a sequence number.
        """
        made = encode(message, self._system, self._component, self._sequence, self._flags)
        self._sequence = (self._sequence + 1) & 0xFF
        return self._signer.sign(made) if self._signer else made
