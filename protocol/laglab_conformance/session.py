"""A talk with the peer under test: provoke it, see whether it reacts."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple, TypeVar

from laglab_conformance.forge import Forged
from laglab_protocol import (
    End,
    Endpoint,
    EndpointError,
    EndReason,
    Frame,
    Listener,
    Message,
    Receiver,
    Signer,
    Verifier,
    read_key,
)

M = TypeVar("M", bound=Message)


class Waits(NamedTuple):
    """Seconds: for the peer to appear, for a reaction that is due, for one that must not come
    (longer where reactions take longer)."""

    appear: float = 10.0
    react: float = 2.0
    refuse: float = 0.4


HELD_UP = 5.0
"""[s] We are not held up for longer: a peer that never stops is listened to no longer."""


class NoReactionError(Exception):
    """The peer did not do what it must; the text says what."""


class DoesNotApplyError(Exception):
    """The item cannot be tested here; the text says why."""


class Session(ABC):
    """What stands opposite the peer under test. `heard` is all that came."""

    system: int
    component: int
    peer: tuple[int, int]
    tick = 0
    """Of the next stimulus."""

    def __init__(self, endpoint: Endpoint, waits: Waits, key_file: Path | None) -> None:
        self.endpoint = endpoint
        self.waits = waits
        self.key = read_key(key_file) if key_file else None
        self.signer = Signer(self.key, (0, self.system, self.component)) if self.key else None
        self.receiver = Receiver(Verifier(self.key) if self.key else None)
        self.heard: list[Frame] = []
        self.heard_at: list[float] = []
        """When each of them came [s]; those of one datagram came at once."""
        self.noise_before = 0
        """Bytes in no frame before the first frame: we may have come in the middle of one."""
        self.over = False
        """Whether we have ended its run."""
        self._sequence = 0
        self._slowest = 0.0
        # A cable that was busy for a moment is no fault of the peer's.
        self._listener = Listener(endpoint, self.receiver, silence=waits.refuse / 2)

    @property
    def refusal(self) -> float:
        """After so many seconds no reaction will come any more: twice as long as any has taken."""
        return max(self.waits.refuse, 2.0 * self._slowest)

    @property
    def ended(self) -> End | None:
        """The peer's word that its run is over, when it was not we who ended it."""
        ends = [] if self.over else self.told(End)
        return ends[0] if ends else None

    @abstractmethod
    def connect(self) -> None:
        """Find the peer. Raises NoReactionError."""

    @abstractmethod
    def stimulus(self) -> Message:
        """The message that the peer must react to now."""

    @abstractmethod
    def is_reaction(self, frame: Frame) -> bool:
        """Whether this frame is the reaction to the stimulus."""

    @abstractmethod
    def go_on(self) -> None:
        """After a reaction: the next stimulus is another one."""

    def leave(self) -> None:
        """Early: the peer is told, thrice, for a frame may be lost, that its run is over."""
        with suppress(EndpointError):  # a link that is broken takes no last words
            for _ in range(3):
                self.send(End(self.tick, EndReason.INTERRUPTED))

    def forged(self, message: Message | None = None) -> Forged:
        """The usual frame of a message, by default the stimulus, with the next number."""
        message = self.stimulus() if message is None else message
        made = Forged.of(message, self.system, self.component, self._sequence, self.signer)
        self._sequence = (self._sequence + 1) & 0xFF
        return made

    def send(self, *messages: Message) -> None:
        """Send messages in one datagram, each in its usual frame."""
        self.endpoint.send(b"".join(self.forged(message).raw for message in messages))

    def told(self, kind: type[M], since: int = 0) -> list[M]:
        """The messages of this kind that came, from frame number `since` on."""
        messages = (frame.message for frame in self.heard[since:])
        return [message for message in messages if isinstance(message, kind)]

    def goes_on(self, kind: type[Message], since: int) -> bool:
        """Whether this kind came after its END, which is among the frames from number `since` on;
        by the frames' own numbers, for a line may bring after it what was said before."""
        heard = self.heard[since:]
        at = [isinstance(frame.message, End) for frame in heard].index(True)
        return any(
            isinstance(frame.message, kind) and (frame.sequence - heard[at].sequence) & 0xFF < 128
            for frame in heard[at + 1 :]
        )

    def wait_for(self, kind: type[M], seconds: float) -> M | None:
        """The next message of this kind, None when none comes in time."""
        found = self.listen(seconds, lambda frame: isinstance(frame.message, kind))
        message = found.message if found else None
        return message if isinstance(message, kind) else None

    def listen(self, seconds: float, until: Callable[[Frame], bool]) -> Frame | None:
        """The first frame for which `until` holds, None when none came in time: what is there by
        the time that we look at the clock came in time, for it may be we who were held up."""
        deadline = time.monotonic() + seconds
        while True:
            left = deadline - time.monotonic()
            for frame in self._receive(max(left, 0.0)):
                if until(frame):
                    return frame
            if left <= 0 and not (self._listener.taken and left > -HELD_UP):
                return None

    def _receive(self, seconds: float) -> list[Frame]:
        frames = self._listener.listen(seconds)
        if frames:
            self.endpoint.accept_peer()
            if not self.heard:
                self.noise_before = self.receiver.counters.noise
            self.heard += frames
            self.heard_at += [time.monotonic()] * len(frames)
        return frames

    def reacts(self, seconds: float) -> bool:
        """Whether the reaction comes; if so the next stimulus is another one."""
        began = time.monotonic()
        if self.listen(seconds, self.is_reaction) is None:
            return False
        self._slowest = max(self._slowest, time.monotonic() - began)
        self.go_on()
        return True

    def exchange(self) -> None:
        """An ordinary stimulus and its reaction. Raises NoReactionError."""
        self.endpoint.send(self.forged().raw)
        if not self.reacts(self.waits.react):
            raise NoReactionError(f"no reaction to {self.stimulus()} within {self.waits.react:g} s")

    def quiet(self) -> None:
        """Take in what is still under way."""
        self.listen(self.refusal, lambda _: False)
