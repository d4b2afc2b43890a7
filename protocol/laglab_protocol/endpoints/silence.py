"""When an unfinished frame is given up."""

from collections.abc import Callable
from time import monotonic

STREAM_SILENCE = 0.05
"""[s] Bytes that follow each other on a serial line, however slow, come sooner than this."""


class Silence:
    """Tells, piece by piece, whether a frame can go on after what has come over one endpoint."""

    def __init__(self, datagrams: bool, now: Callable[[], float] = monotonic) -> None:
        self._datagrams = datagrams
        self._now = now
        self._last_byte = now()

    def after(self, data: bytes) -> bool:
        """Whether no frame goes on after `data`, which may be nothing at all.

        A datagram is a unit; on a stream frames come in pieces, and only a real silence tells that
        the rest is lost.
        """
        if self._datagrams:
            return True
        now = self._now()
        if data:
            self._last_byte = now
        return now - self._last_byte >= STREAM_SILENCE
