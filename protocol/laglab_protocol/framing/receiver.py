"""Bytes in, verified frames out.

Whatever is no intact frame is counted and passed over: no bytes raise, and none that are not
verified change anything but those counts. After a false start the search resumes one byte later,
so every intact frame is found, whatever stands around it, but not inside another one (`nested`);
a datagram is a unit, so what is cut off at its end does not swallow the next one.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from laglab_protocol.framing.frame import START, Frame, Refusal, decode
from laglab_protocol.framing.nested import frames_within, outer_end, was_whole
from laglab_protocol.framing.starts import next_start
from laglab_protocol.signing.signature import Verifier

Peer = tuple[int, int]
"""(system, component)."""


@dataclass(frozen=True, slots=True)
class Counters:
    """What a receiver has seen so far."""

    frames: int = 0
    """Frames delivered."""
    noise: int = 0
    """Bytes that belong to no delivered frame."""
    refused: dict[Refusal, int] = field(default_factory=dict)
    """Start bytes from which no frame came, by reason (start bytes in noise are among them)."""
    lost: dict[Peer, int] = field(default_factory=dict)
    """Gaps in the sequence numbers. A frame up to 128 behind is late or repeated: not a gap."""
    late: dict[Peer, int] = field(default_factory=dict)
    """Frames that came after their successors, or twice."""
    nested: int = 0
    """Frames delivered although they stood inside what claimed to be one, and was refused."""


class Receiver:
    """Finds the frames in a stream, or in one datagram after another. No I/O.

    With a verifier only what it lets pass is delivered; without one, only what is not signed.
    """

    def __init__(self, verifier: Verifier | None = None, nested: bool | None = None) -> None:
        """`nested`: whether a frame inside another that was whole and was refused is delivered all
        the same; by default where there is a key, for then one of its holders made it."""
        self._nested_too = verifier is not None if nested is None else nested
        self._nested = 0
        self._aligned = True
        """Whether what is kept stands right behind a frame."""
        self._within = 0
        """If not: so many bytes stand inside a frame that was refused."""
        self._verifier = verifier
        self._rest = b""
        self._frames = 0
        self._noise = 0
        self._refused: Counter[Refusal] = Counter()
        self._expected: dict[int, int] = {}  # by system << 8 | component
        self._lost: Counter[int] = Counter()
        self._late: Counter[int] = Counter()

    @property
    def counters(self) -> Counters:
        """A snapshot; later bytes do not change it."""
        return Counters(
            self._frames,
            self._noise,
            dict(self._refused),
            _by_peer(self._lost),
            _by_peer(self._late),
            self._nested,
        )

    @property
    def refused(self) -> Mapping[Refusal, int]:
        """As in the counters, and as it changes."""
        return self._refused

    def receive(self, data: bytes, whole: bool = False) -> list[Frame]:
        """The frames that `data`, after the bytes received before, completes.

        `whole`: no frame goes on after it, for it is a datagram, or a silence follows that is
        longer than a frame takes; an unfinished frame is given up, and what its start byte hid is
        found. Otherwise at most one unfinished frame is kept: under 300 bytes.
        """
        buffer = data
        if self._rest:
            buffer, self._rest = self._rest + data, b""
        aligned = self._aligned
        within = 0 if aligned else self._within
        astray = not aligned
        verifier, expected = self._verifier, self._expected
        signed_too = verifier is not None
        frames: list[Frame] = []
        position, size = 0, len(buffer)
        while position < size:
            found = decode(buffer, position, signed_too) if buffer[position] == START else None
            if verifier and type(found) is Frame:
                found = verifier.refuses(found) or found
            if type(found) is Frame:
                peer = found.system << 8 | found.component
                sequence = found.sequence
                if expected.get(peer) == sequence:
                    expected[peer] = (sequence + 1) & 0xFF
                else:
                    self._out_of_sequence(peer, sequence)
                frames.append(found)
                position += len(found.raw)
                if astray:
                    self._nested += position <= within
                    aligned, astray = True, within > 0
            elif found is Refusal.INCOMPLETE:
                self._rest = buffer[position:]
                break
            else:
                position, end = self._refuse(found, buffer, position, aligned)
                aligned, within, astray = position == end, max(within, end), True
        self._aligned = aligned
        self._frames += len(frames)
        if whole:
            if self._rest:
                frames += self._given_up()
            self._aligned = True
        return frames

    def _given_up(self) -> list[Frame]:
        """Of what was no frame only the start byte is: the frames behind it."""
        frames: list[Frame] = []
        while self._rest:
            self._refused[Refusal.INCOMPLETE] += 1
            self._noise += 1
            behind, self._rest = self._rest[1:], b""
            self._aligned, self._within = False, len(behind)
            frames += self.receive(behind)
        self._within = 0
        return frames

    def _refuse(
        self, refusal: Refusal | None, buffer: bytes, position: int, aligned: bool
    ) -> tuple[int, int]:
        """Where to look on, and where what was refused ends by its own word."""
        end = outer_end(buffer, position) if refusal else 0
        may_hide = end > 0 and not self._nested_too
        if not (refusal and may_hide and was_whole(buffer, position, end, refusal, aligned)):
            return self._pass_over(refusal, buffer, position), end
        self._refused[refusal] += 1
        if inside := frames_within(buffer, position + 1, end):
            self._refused[Refusal.NESTED] += inside
        self._noise += end - position
        return end, end

    def _pass_over(self, refusal: Refusal | None, buffer: bytes, position: int) -> int:
        """The position of the next possible start: at least one byte on, however long the frame."""
        if refusal:
            self._refused[refusal] += 1
        after = next_start(buffer, position + 1)
        if unknown := buffer.count(START, position + 1, after):
            self._refused[Refusal.UNKNOWN] += unknown
        self._noise += after - position
        return after

    def _out_of_sequence(self, peer: int, sequence: int) -> None:
        gap = (sequence - self._expected.get(peer, sequence)) & 0xFF
        if gap >= 128:
            self._late[peer] += 1
            return
        if gap:
            self._lost[peer] += gap
        self._expected[peer] = (sequence + 1) & 0xFF


def frames_in(datagram: bytes) -> list[Frame]:
    """All the frames in one datagram that are not signed."""
    return Receiver().receive(datagram, whole=True)


def _by_peer(counts: Counter[int]) -> dict[Peer, int]:
    return {(key >> 8, key & 0xFF): count for key, count in counts.items()}
