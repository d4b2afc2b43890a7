"""One station's voice: it numbers the frames that it makes."""

from laglab_protocol.frame import encode
from laglab_protocol.messages import Message


class Sender:
    """Makes the frames of one (system, component). No I/O."""

    def __init__(self, system: int, component: int) -> None:
        self._system = system
        self._component = component
        self._sequence = 0

    def frame(self, message: Message) -> bytes:
        """The next frame, with `message` in it.

        Raises DialectError for a class that is no message, struct.error for a value out of range;
        neither uses up a sequence number.
        """
        made = encode(message, self._system, self._component, self._sequence)
        self._sequence = (self._sequence + 1) & 0xFF
        return made
