"""Listening: bytes in, frames out, whatever they come over."""

from collections.abc import Callable, Mapping
from time import monotonic

from laglab_protocol.endpoints import Link
from laglab_protocol.framing.frame import Frame, Refusal
from laglab_protocol.framing.receiver import Receiver

STREAM_SILENCE = 0.08
"""[s] Bytes that follow each other on a serial line, however slow, come sooner than this, and who
is not answered sends again later than this."""


class Listener:
    """One end of a link, and the receiver of what comes over it.

    A datagram is a unit; on a stream frames come in pieces, and only a real silence tells that the
    rest of one is lost, or that it was no frame.
    """

    def __init__(
        self,
        link: Link,
        receiver: Receiver,
        now: Callable[[], float] = monotonic,
        silence: float = STREAM_SILENCE,
    ) -> None:
        """`silence` [s]: what is unfinished on a stream is given up after it."""
        self.link = link
        self._receiver = receiver
        self._now = now
        self._silence = silence
        self._last_byte = now()
        self.taken = 0
        """Bytes that came at the last `listen`."""

    def listen(self, timeout: float) -> list[Frame]:
        """The frames that are whole with what arrives within `timeout` [s]."""
        if self.link.datagrams:
            data = self._take(timeout)
            return self._receiver.receive(data, whole=True) if data else []
        until = self._now() + timeout
        if data := self._take(timeout):
            self._last_byte = self._now()
            return self._receiver.receive(data)
        # Silent until then, not until now: more may have come while we waited for the processor.
        return self._receiver.receive(b"", whole=until - self._last_byte >= self._silence)

    def _take(self, timeout: float) -> bytes:
        data = self.link.receive(timeout)
        self.taken = len(data)
        return data

    def forget(self) -> None:
        """Pass over all that has arrived so far."""
        while self.link.receive(0.0):
            pass
        self._receiver.receive(b"", whole=True)

    @property
    def refused(self) -> Mapping[Refusal, int]:
        """How many start bytes so far led to no frame, by reason."""
        return self._receiver.refused
