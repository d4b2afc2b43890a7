"""Listening: bytes in, frames out, whatever they come over."""

from collections.abc import Callable
from time import monotonic

from laglab_protocol.endpoints import Link
from laglab_protocol.framing.frame import Frame, Refusal
from laglab_protocol.framing.receiver import Receiver

STREAM_SILENCE = 0.05
"""[s] Bytes that follow each other on a serial line, however slow, come sooner than this."""

KEYS = {
    (Refusal.UNSIGNED, Refusal.BAD_SIGNATURE): "not signed with this key",
    (Refusal.NO_KEY,): "they are signed, and here is no key to check that with",
}


class Listener:
    """One end of a link, and the receiver of what comes over it.

    A datagram is a unit; on a stream frames come in pieces, and only a real silence tells that the
    rest of one is lost, or that it was none.
    """

    def __init__(
        self, link: Link, receiver: Receiver, now: Callable[[], float] = monotonic
    ) -> None:
        self.link = link
        self._receiver = receiver
        self._now = now
        self._last_byte = now()
        self.idle = True
        """Whether nothing at all came the last time."""

    def listen(self, timeout: float) -> list[Frame]:
        """The frames that are whole with what arrives within `timeout` [s]."""
        data = self.link.receive(timeout)
        self.idle = not data
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
    def refused(self) -> str:
        """What was not taken so far because of its signature, in a line; empty when nothing was."""
        counts = self._receiver.counters.refused
        for reasons, why in KEYS.items():
            if count := sum(counts.get(reason, 0) for reason in reasons):
                return f"{self.link.name}: {count} frames refused: {why}"
        return ""
