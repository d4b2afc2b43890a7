"""Where in a buffer a frame may begin: in garbage, ten times as fast as reading each header."""

import re
from collections import defaultdict
from collections.abc import Iterable

from laglab_protocol.framing.frame import CRC_SIZE, HEADER_SIZE, START
from laglab_protocol.messages.layout import LAYOUT_OF_ID


def _headers(numbers: Iterable[int]) -> re.Pattern[bytes]:
    """A start byte, six of whatever, and one of these message ids: lowest byte first."""
    lows = defaultdict[bytes, bytes](bytes)
    for number in sorted(numbers):
        low, *rest = number.to_bytes(3, "little")
        lows[bytes(rest)] += bytes([low])
    ids = (b"[%s]%s" % (re.escape(low), re.escape(rest)) for rest, low in lows.items())
    return re.compile(b"\xfd.{6}(?:%s)" % b"|".join(ids), re.DOTALL)


_known = _headers(LAYOUT_OF_ID).search


def next_start(buffer: bytes, position: int) -> int:
    """The first start byte from `position` on whose message we know, or that has too little behind
    it to tell; the end of the buffer if there is none."""
    known = _known(buffer, position)
    tail = max(position, len(buffer) - HEADER_SIZE - CRC_SIZE + 1)
    unfinished = buffer.find(START, tail)
    found = len(buffer) if known is None else known.start()
    return found if unfinished < 0 else min(found, unfinished)
