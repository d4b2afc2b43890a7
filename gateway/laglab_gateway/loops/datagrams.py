"""Frames in pieces that every path carries."""

from collections.abc import Iterator, Sequence

LARGEST_SENT = 1200
"""[bytes] Every path carries so many in one piece, and no answer is worth more than a piece."""


def datagrams(frames: Sequence[bytes]) -> Iterator[bytes]:
    """The frames in as few pieces as may be; none for none."""
    piece = b""
    for frame in frames:
        if piece and len(piece) + len(frame) > LARGEST_SENT:
            yield piece
            piece = b""
        piece += frame
    if piece:
        yield piece
