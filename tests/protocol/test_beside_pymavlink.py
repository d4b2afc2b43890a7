"""Our receiver and pymavlink's on the same bytes: every intact frame, against some of them."""

import random
from collections.abc import Callable

import pytest

from laglab_protocol import Receiver

from .golden import GOLDEN
from .pymavlink_receiver import frames_of_pymavlink

FRAMES = [row.raw for row in GOLDEN]


def ours(datagrams: list[bytes]) -> list[bytes]:
    receiver = Receiver(nested=True)  # also what stands in refused frames, as pymavlink
    frames = []
    for datagram in datagrams:
        frames += receiver.receive(datagram, whole=True)
    return [frame.raw for frame in frames]


def false_starts() -> tuple[list[bytes], list[bytes]]:
    """A start byte and a length out of nowhere, before each ten frames."""
    return [b"\xfd\xff" + b"".join(FRAMES[:10])] * 20, FRAMES[:10] * 20


def flipped_bits() -> tuple[list[bytes], list[bytes]]:
    """A line that flips one bit in a few thousand."""
    noise = random.Random(4)
    sent = FRAMES * 200
    damaged = [
        bytes(byte ^ (1 << noise.randrange(8) if noise.random() < 0.003 else 0) for byte in raw)
        for raw in sent
    ]
    intact = [raw for raw, after in zip(sent, damaged, strict=True) if raw == after]
    return [b"".join(damaged)], intact


def dropped_bytes() -> tuple[list[bytes], list[bytes]]:
    """A serial port that overruns now and then."""
    noise = random.Random(5)
    sent = FRAMES * 50
    damaged = [bytes(byte for byte in raw if noise.random() > 0.003) for raw in sent]
    intact = [raw for raw, after in zip(sent, damaged, strict=True) if raw == after]
    return [b"".join(damaged)], intact


def cut_datagrams() -> tuple[list[bytes], list[bytes]]:
    """Every other datagram loses its end."""
    datagrams, intact = [], []
    for first, second in zip(FRAMES, FRAMES[1:] + FRAMES[:1], strict=True):
        datagrams += [first[:-3], second]
        intact.append(second)
    return datagrams, intact


@pytest.mark.parametrize("line", [false_starts, flipped_bits, dropped_bytes, cut_datagrams])
def test_every_intact_frame_where_pymavlink_loses_some(
    line: Callable[[], tuple[list[bytes], list[bytes]]],
) -> None:
    datagrams, intact = line()
    theirs = frames_of_pymavlink(datagrams)

    assert ours(datagrams) == intact
    assert len(theirs) < len(intact)
    print(f"{line.__name__}: ours {len(intact)} of {len(intact)}, pymavlink {len(theirs)}")


def test_on_a_clean_line_both_find_all() -> None:
    assert ours([b"".join(FRAMES)]) == frames_of_pymavlink([b"".join(FRAMES)]) == FRAMES
