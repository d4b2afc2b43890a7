"""Listening: bytes in, frames out, whatever they come over."""

from collections.abc import Callable, Mapping
from time import monotonic

from laglab_protocol.endpoints import Link
from laglab_protocol.framing.frame import Frame, Refusal
from laglab_protocol.framing.receiver import Receiver

STREAM_SILENCE = 0.05
"""[s] Bytes that follow each other on a serial line, however slow, come sooner than this."""


class Listener:
    """One end of a link, and the receiver of what comes over it.

    A datagram is a unit; on a stream frames come in pieces, and only a real silence tells that the
    rest of one is lost, or that it was no frame.
    """

    def __init__(
        self, link: Link, receiver: Receiver, now: Callable[[], float] = monotonic
    ) -> None:
        self.link = link
        self._receiver = receiver
        self._now = now
        self._last_byte = now()
        self.taken = 0
        """Bytes that came at the last `listen`."""

    def listen(self, timeout: float) -> list[Frame]:
        """The frames that are whole with what arrives within `timeout` [s]."""
        data = self.link.receive(timeout)
        self.taken = len(data)
        if self.link.datagrams:
            return self._receiver.receive(data, whole=True) if data else []
        now = self._now()
        if data:
            self._last_byte = now
        return self._receiver.receive(data, whole=now - self._last_byte >= STREAM_SILENCE)

    def forget(self) -> None:
        """Pass over all that has arrived so far."""
        while self.link.receive(0.0):
            pass
        self._receiver.receive(b"", whole=True)

    @property
    def refused(self) -> Mapping[Refusal, int]:
        """How many start bytes so far led to no frame, by reason."""
        return self._receiver.refused
