"""MAVLink 2 signatures: who holds the key may speak, and nothing said is accepted twice.

A signed frame ends with a link id (1 byte), a timestamp (6, in 10 us since 2015) and the first six
bytes of SHA-256(key, frame so far, link id, timestamp). The streams of a key are told apart by
(link id, system, component); in each the timestamp only grows
(https://mavlink.io/en/guide/message_signing.html).
"""

import hmac
import time
from collections.abc import Callable
from hashlib import sha256
from typing import TYPE_CHECKING

from laglab_protocol.frame import SIGNATURE_SIZE, SIGNED, Frame, Refusal
from laglab_protocol.layout import layout_of

if TYPE_CHECKING:
    from hashlib import _Hash

KEY_SIZE = 32
EPOCH_NS = 1_420_070_400 * 10**9
"""1 January 2015 UTC in Unix time [ns], where the timestamps start."""
MINUTE = 60 * 100_000
"""In timestamps: a stream that we do not know may not start further behind than this."""

Stream = tuple[int, int, int]
"""(link id, system, component)."""
Clock = Callable[[], int]


def signing_time() -> int:
    """Now, as a timestamp: in 10 us since the start of 2015."""
    return (time.time_ns() - EPOCH_NS) // 10_000


class Timestamps:
    """The last timestamp of each stream, our own included. This one forgets at the end."""

    def __init__(self) -> None:
        self.last: dict[Stream, int] = {}

    def advance(self, stream: Stream, timestamp: int) -> None:
        """The stream has now said this, and may not say it again."""
        self.last[stream] = timestamp

    def close(self) -> None:
        """Nothing more will be said."""


class Signer:
    """Signs the frames of one (system, component)."""

    def __init__(
        self,
        key: bytes,
        stream: Stream,
        timestamps: Timestamps | None = None,
        clock: Clock = signing_time,
    ) -> None:
        self._keyed = sha256(key)
        self._stream = stream
        self._link = bytes([stream[0]])
        self._timestamps = timestamps or Timestamps()
        self._clock = clock

    def sign(self, frame: bytes) -> bytes:
        """`frame`, which carries the SIGNED flag, with its signature. No timestamp comes twice."""
        last = self._timestamps.last.get(self._stream, 0)
        timestamp = max(last + 1, self._clock())
        self._timestamps.advance(self._stream, timestamp)
        stamped = frame + self._link + timestamp.to_bytes(6, "little")
        return stamped + _signature(self._keyed, stamped)


class Verifier:
    """Tells which frames may pass; a frame that may not changes nothing here."""

    def __init__(
        self,
        key: bytes,
        timestamps: Timestamps | None = None,
        allow_unsigned: frozenset[str] = frozenset(),
        clock: Clock = signing_time,
    ) -> None:
        self._keyed = sha256(key)
        self._timestamps = timestamps or Timestamps()
        self._allow_unsigned = allow_unsigned
        self._clock = clock

    def refuses(self, frame: Frame) -> Refusal | None:
        """Why `frame` may not pass, None when it may. `allow_unsigned` holds message names."""
        raw = frame.raw
        if not raw[2] & SIGNED:
            allowed = layout_of(frame.message).name in self._allow_unsigned
            return None if allowed else Refusal.UNSIGNED
        if not hmac.compare_digest(_signature(self._keyed, raw[:-6]), raw[-6:]):
            return Refusal.BAD_SIGNATURE
        stream = (raw[-SIGNATURE_SIZE], frame.system, frame.component)
        timestamp = int.from_bytes(raw[-12:-6], "little")
        last = self._timestamps.last.get(stream)
        if timestamp <= (self._earliest_new() if last is None else last):
            return Refusal.REPLAYED
        self._timestamps.advance(stream, timestamp)
        return None

    def _earliest_new(self) -> int:
        return max(self._clock(), *self._timestamps.last.values(), 0) - MINUTE


def _signature(keyed: "_Hash", data: bytes) -> bytes:
    digest = keyed.copy()
    digest.update(data)
    return digest.digest()[:6]
