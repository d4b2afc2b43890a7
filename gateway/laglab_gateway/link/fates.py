"""What becomes of each frame on an impaired link. Seeded, and without a clock: time is given."""

import math
from collections.abc import Sequence
from enum import StrEnum
from statistics import NormalDist
from typing import NamedTuple, Protocol

import numpy as np

from laglab_gateway.link.impairments import Burst, ExtraDelay, Impairments
from laglab_gateway.link.timeline import Event, in_force, within

LEAST_SHARE = 1e-12
"""What is rarer is drawn as if it were as rare as that: at 0 and 1 delays may be infinite."""
LONGEST_EXTRA = 1e4
"""[s] No frame is later than that."""


class FateKind(StrEnum):
    """What the link did to a frame."""

    DELIVERED = "delivered"
    LOST = "lost"
    BURST = "burst"
    OUTAGE = "outage"
    QUEUE_FULL = "queue-full"
    CORRUPTED = "corrupted"
    LATE = "late"
    """Delivered, when play-out had no more use for it."""


class Fate(NamedTuple):
    """One copy of a frame: what was done, how much later than the fixed delay [s], its bytes."""

    kind: FateKind
    extra: float
    raw: bytes


class Fates(Protocol):
    """Decides, frame after frame in the order in which they enter."""

    def of(self, tick: int, time: float, raw: bytes) -> list[Fate]:
        """The fate of each copy of a frame that enters at `time` [s], in the tick `tick`."""


class RandomFates:
    """Impairments of one direction, drawn from a generator of its own."""

    def __init__(
        self, impairments: Impairments, events: Sequence[Event], rng: np.random.Generator
    ) -> None:
        self._impairments = impairments
        self._events = events
        self._rng = rng
        self._bad = False
        self._line_free = 0.0
        self._score: float | None = None

    def of(self, tick: int, time: float, raw: bytes) -> list[Fate]:  # noqa: ARG002 the time tells
        """In the order in which a real link does it: lost on air, queued, bits flipped, late."""
        link = in_force(self._impairments, self._events, time)
        if lost := self._loss(link, time):
            return [Fate(lost, 0.0, raw)]
        waited = self._queue(link, time, len(raw))
        if waited is None:
            return [Fate(FateKind.QUEUE_FULL, 0.0, raw)]
        received = self._flip_bits(link, raw)
        kind = FateKind.DELIVERED if received == raw else FateKind.CORRUPTED
        copies = 2 if self._happens(link.duplicate) else 1
        late = (waited + self._late(link) for _ in range(copies))
        return [Fate(kind, min(each, LONGEST_EXTRA), received) for each in late]

    def _happens(self, probability: float) -> bool:
        return probability > 0 and self._rng.random() < probability

    def _loss(self, link: Impairments, time: float) -> FateKind | None:
        for start, duration in link.outages:
            if within(time, start, duration):
                return FateKind.OUTAGE
        if self._happens(link.loss):
            return FateKind.LOST
        return FateKind.BURST if link.burst and self._burst_loss(link.burst) else None

    def _burst_loss(self, burst: Burst) -> bool:
        moves = burst.bad_to_good if self._bad else burst.good_to_bad
        self._bad ^= self._happens(moves)
        return self._happens(burst.loss_bad if self._bad else burst.loss_good)

    def _queue(self, link: Impairments, time: float, size: int) -> float | None:
        """Seconds until the line has taken the frame; None when the queue is full."""
        if link.bandwidth is None:
            return 0.0
        backlog = max(0.0, self._line_free - time)
        if backlog * link.bandwidth / 8 + size > link.queue:
            return None
        self._line_free = time + backlog + size * 8 / link.bandwidth
        return self._line_free - time

    def _flip_bits(self, link: Impairments, raw: bytes) -> bytes:
        if link.bit_error_rate == 0:
            return raw
        flips = self._rng.random(8 * len(raw)) < link.bit_error_rate
        return bytes(np.frombuffer(raw, np.uint8) ^ np.packbits(flips))

    def _late(self, link: Impairments) -> float:
        extra = self._extra(link.extra_delay) if link.extra_delay else 0.0
        return extra + (link.reorder_by if self._happens(link.reorder) else 0.0)

    def _extra(self, delay: ExtraDelay) -> float:
        """Correlated delays have normal scores that wander: an autoregression of first order."""
        if delay.correlation == 0:
            return delay.draw(self._rng)
        new = self._rng.standard_normal()
        if self._score is None:
            self._score = new
        else:
            kept = delay.correlation
            self._score = kept * self._score + math.sqrt(1 - kept**2) * new
        return delay.at(min(max(NormalDist().cdf(self._score), LEAST_SHARE), 1 - LEAST_SHARE))
