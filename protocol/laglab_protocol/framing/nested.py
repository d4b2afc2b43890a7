"""Packet in packet: what looks like a frame inside a frame that was refused.

Whoever may choose the payload of somebody else's message (a text, a file, a tunnel) can put a whole
frame into it. Once the outer frame is refused, because noise on the radio flipped a bit of it, or
for its signature, a receiver that looks on inside would deliver the inner one.
"""

from laglab_protocol.framing.frame import (
    CRC_SIZE,
    HEADER_SIZE,
    START,
    Frame,
    Refusal,
    decode,
    extent,
    is_intact,
)
from laglab_protocol.framing.starts import next_start

CHECKABLE = (Refusal.NO_KEY, Refusal.INCOMPATIBLE)
"""Refused for these a frame may be intact all the same."""


def outer_end(buffer: bytes, start: int) -> int:
    """Where the frame that was refused at `start` ends by its header; 0 if not all is there."""
    if start + HEADER_SIZE + CRC_SIZE > len(buffer):
        return 0
    end = extent(buffer, start)
    return end if end <= len(buffer) else 0


def was_whole(buffer: bytes, start: int, end: int, refusal: Refusal, aligned: bool) -> bool:
    """Whether what was refused is a frame from `start` to `end`, and no false start.

    Its CRC tells; where that is wrong, or cannot be known, its place does: right behind the frame
    before it (`aligned`), with nothing or the next one right behind it.
    """
    if aligned and (end == len(buffer) or buffer[end] == START):
        return True
    return refusal in CHECKABLE and is_intact(buffer, start)


def frames_within(buffer: bytes, start: int, end: int) -> int:
    """How many intact frames there are in that stretch."""
    inner, found, position = buffer[start:end], 0, 0
    while (position := next_start(inner, position)) < len(inner):
        frame = decode(inner, position)
        found += isinstance(frame, Frame)
        position += len(frame.raw) if isinstance(frame, Frame) else 1
    return found
