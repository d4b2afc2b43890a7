"""MAVLink 2 signatures: who holds the key may speak, and nothing said is accepted twice.

A signed frame ends with a link id (1 byte), a timestamp (6, in 10 us since 2015) and the first six
bytes of SHA-256(key, frame so far, link id, timestamp). The streams of a key are told apart by
(link id, system, component); in each the timestamp only grows
(https://mavlink.io/en/guide/message_signing.html).
"""

import struct
import time
from collections.abc import Callable
from dataclasses import dataclass
from hashlib import sha256
from hmac import compare_digest

from laglab_protocol.framing.frame import SIGNATURE_SIZE, SIGNED, Frame, Refusal
from laglab_protocol.messages.layout import LAYOUT_OF_ID, layout_of

KEY_SIZE = 32
EPOCH_NS = 1_420_070_400 * 10**9
"""1 January 2015 UTC in Unix time [ns], where the timestamps start."""
MINUTE = 60 * 100_000
"""In timestamps: a stream that we do not know may not start further behind than this, and none may
go further ahead of our clock. Else one clock in the future would lock all new streams out."""

_unpack_signature = struct.Struct("<BIH6s").unpack_from

EVERY_MESSAGE = frozenset(layout.name for layout in LAYOUT_OF_ID.values())
"""By name, for those who need not sign."""
CLOCK_EVERY = 16
"""Timestamps: in between a signer counts on, for reading the clock costs a third of signing."""
_NEXT = 1 << 24
"""One timestamp more where CRC and link id stand below it, as the three travel."""

Stream = tuple[int, int, int]
"""(link id, system, component)."""
Clock = Callable[[], int]
AHEAD = 100_000
"""Timestamps, one second: so far ahead a stream may go on before its place is kept again."""


def signing_time() -> int:
    """Now, as a timestamp: in 10 us since the start of 2015."""
    return (time.time_ns() - EPOCH_NS) // 10_000


@dataclass(slots=True)
class Place:
    """Where a stream has got to: its last timestamp, and how far it may go on without asking."""

    last: int
    reserved: int


class Timestamps:
    """The place of each stream, our own included, kept only as long as the program runs."""

    def __init__(self) -> None:
        self.places: dict[Stream, Place] = {}

    @property
    def last(self) -> dict[Stream, int]:
        """The last timestamp of each stream."""
        return {stream: place.last for stream, place in self.places.items()}

    def reserve(self, stream: Stream, timestamp: int) -> int:
        """Asked before `timestamp` counts: up to which one the stream may go on without asking."""
        del stream
        return timestamp + AHEAD

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
        self._key = key
        self._stream = stream
        self._timestamps = timestamps or Timestamps()
        self._place = self._timestamps.places.get(stream) or Place(0, 0)
        self._latest = self._place.last << 24 | stream[0] << 16
        self._counting_until = 0
        self._clock = clock

    def sign(self, frame: bytes, crc: int) -> bytes:
        """`frame`, which ends before its CRC, with CRC and signature. No timestamp comes twice."""
        latest = self._latest + _NEXT
        if latest >= self._counting_until:
            latest = self._by_the_clock(latest)
        self._latest = latest
        stamped = frame + (latest | crc).to_bytes(9, "little")
        # Hashing the key anew each time costs less than copying a hash that has taken it in.
        return stamped + sha256(self._key + stamped).digest()[:6]

    def _by_the_clock(self, least: int) -> int:
        timestamp, place = max(least >> 24, self._clock()), self._place
        if timestamp > place.reserved:
            place.last = place.reserved = self._timestamps.reserve(self._stream, timestamp)
            self._timestamps.places[self._stream] = place
        self._counting_until = min(timestamp + CLOCK_EVERY, place.reserved + 1) << 24
        return timestamp << 24 | self._stream[0] << 16


class Verifier:
    """Tells which frames may pass; a frame that may not changes nothing here. `allow_unsigned`:
    names of the messages that need no signature."""

    def __init__(
        self,
        key: bytes,
        timestamps: Timestamps | None = None,
        allow_unsigned: frozenset[str] = frozenset(),
        clock: Clock = signing_time,
    ) -> None:
        self._key = key
        self._timestamps = timestamps or Timestamps()
        self._places = self._timestamps.places
        self._allow_unsigned = allow_unsigned
        self._clock = clock

    def refuses(self, frame: Frame) -> Refusal | None:
        """Why `frame` may not pass, None when it may. Raises KeyFileError where `reserve` does."""
        raw = frame.raw
        if not raw[2] & SIGNED:
            allowed = layout_of(frame.message).name in self._allow_unsigned
            return None if allowed else Refusal.UNSIGNED
        link, low, high, signature = _unpack_signature(raw, -SIGNATURE_SIZE)
        if not compare_digest(sha256(self._key + raw[:-6]).digest()[:6], signature):
            return Refusal.BAD_SIGNATURE
        stream, timestamp = (link, frame.system, frame.component), low | high << 32
        place = self._places.get(stream)
        if place is None or not place.last < timestamp <= place.reserved:
            return self._unreserved(stream, timestamp)
        place.last = timestamp
        return None

    def _unreserved(self, stream: Stream, timestamp: int) -> Refusal | None:
        place = self._places.get(stream)
        if timestamp <= (place.last if place else self._earliest_new()):
            return Refusal.REPLAYED
        if timestamp > self._clock() + MINUTE:
            return Refusal.AHEAD
        self._places[stream] = Place(timestamp, self._timestamps.reserve(stream, timestamp))
        return None

    def _earliest_new(self) -> int:
        """A new stream starts later than this. What is too far ahead came of a wrong clock."""
        now = self._clock()
        believed = [last for last in self._timestamps.last.values() if last <= now + MINUTE]
        return max(now, *believed, 0) - MINUTE
