"""The receiver finds every intact frame, whatever stands around it, and counts the rest."""

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from laglab_protocol import (
    Frame,
    Measurement,
    Message,
    Receiver,
    Refusal,
    Sender,
    Tick,
    decode,
)
from laglab_protocol.framing.starts import next_start

from .strategies import messages


def frames_of(count: int, system: int = 1, component: int = 1) -> list[bytes]:
    sender = Sender(system, component)
    return [
        sender.frame(Measurement(k / 3, -k, math.sin(k), 0.1, 0.2, k, k - 1)) for k in range(count)
    ]


def raws(frames: list[Frame]) -> list[bytes]:
    return [frame.raw for frame in frames]


def test_every_split_point() -> None:
    sent = frames_of(3)
    stream = b"".join(sent)
    for split in range(len(stream) + 1):
        receiver = Receiver()
        assert raws(receiver.receive(stream[:split]) + receiver.receive(stream[split:])) == sent


def test_byte_by_byte() -> None:
    sent = frames_of(3)
    receiver = Receiver()

    received = [frame for byte in b"".join(sent) for frame in receiver.receive(bytes([byte]))]

    assert raws(received) == sent
    assert receiver.counters.noise == 0


@given(st.lists(messages(), max_size=5), st.data())
def test_any_cutting_of_a_stream(sent: list[Message], data: st.DataObject) -> None:
    sender, receiver = Sender(1, 1), Receiver()
    stream = b"".join(sender.frame(message) for message in sent)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=8)))
    received = []
    for start, stop in zip([0, *cuts], [*cuts, len(stream)], strict=True):
        received += receiver.receive(stream[start:stop])

    assert [frame.message for frame in received] == sent


@pytest.mark.parametrize("nested", [True, False])
@given(st.lists(st.binary(max_size=40), min_size=4, max_size=4))
@example([b"\xfd\x2e\x01" + bytes(8), b"", b"", b""])  # a header whose frame ends with the first
def test_garbage_between_frames_costs_no_frame(nested: bool, garbage: list[bytes]) -> None:
    """But one that, by the garbage before it, is inside another: that is delivered on request."""
    sent = frames_of(3)
    mixed = garbage[0] + b"".join(map(bytes.__add__, sent, garbage[1:]))
    receiver = Receiver(nested=nested)

    received = raws(receiver.receive(mixed, whole=True))

    inside = receiver.counters.refused.get(Refusal.NESTED, 0)
    assert not (nested and inside)
    assert [raw for raw in sent if raw in received] == [raw for raw in received if raw in sent]
    assert sum(raw in received for raw in sent) == len(sent) - inside
    assert receiver.counters.noise == len(mixed) - sum(map(len, received))


@pytest.mark.parametrize("start", [b"\xfd", b"\xfd\xff", b"\xfd\xff\0\0\0\1\1\x85\xcb\0", b"\xfe"])
def test_a_false_start_costs_no_frame(start: bytes) -> None:
    sent = frames_of(10)
    receiver = Receiver()

    received = receiver.receive(start + b"".join(sent), whole=True)

    assert raws(received) == sent


def test_a_dropped_byte_costs_one_frame() -> None:
    sent = frames_of(5)
    stream = sent[0] + sent[1] + sent[2][:20] + sent[2][21:] + sent[3] + sent[4]
    receiver = Receiver()

    received = receiver.receive(stream)

    assert raws(received) == [sent[0], sent[1], sent[3], sent[4]]
    assert receiver.counters.lost == {(1, 1): 1}


def test_a_truncated_datagram_does_not_eat_the_next() -> None:
    first, second = frames_of(2)
    receiver = Receiver()

    assert receiver.receive(first[:-5]) == []
    assert receiver.receive(b"", whole=True) == []
    assert raws(receiver.receive(second)) == [second]
    assert receiver.counters.refused[Refusal.INCOMPLETE] == 1


def test_corruption_anywhere_costs_only_its_own_frame() -> None:
    sent = frames_of(3)
    for position in range(len(sent[1])):
        bad = bytearray(sent[1])
        bad[position] ^= 0x55
        receiver = Receiver()
        received = receiver.receive(sent[0] + bad + sent[2], whole=True)
        assert raws(received) == [sent[0], sent[2]]


def test_losses_are_counted_per_system_and_component() -> None:
    receiver = Receiver()
    first, second = frames_of(300, 1, 1), frames_of(300, 1, 2)
    receiver.receive(b"".join(first[:10] + first[13:] + second[:250] + second[260:]))

    assert receiver.counters.lost == {(1, 1): 3, (1, 2): 10}
    assert receiver.counters.frames == 297 + 290


def test_late_and_repeated_frames_are_no_losses() -> None:
    a, b, c = frames_of(3)
    receiver = Receiver()
    receiver.receive(a + c + b + c)

    assert receiver.counters.lost == {(1, 1): 1}
    assert receiver.counters.late == {(1, 1): 2}


@pytest.mark.parametrize(("behind", "late", "lost"), [(128, 1, 0), (129, 0, 127)])
def test_a_frame_is_late_up_to_half_of_all_sequence_numbers(
    behind: int, late: int, lost: int
) -> None:
    sent = frames_of(130)
    receiver = Receiver()
    receiver.receive(b"".join(sent))
    receiver.receive(sent[130 - behind])

    assert receiver.counters.late.get((1, 1), 0) == late
    assert receiver.counters.lost.get((1, 1), 0) == lost


def test_counters_are_a_snapshot() -> None:
    receiver = Receiver()
    before = receiver.counters
    receiver.receive(Sender(1, 1).frame(Tick(1, 0)))

    assert before.frames == 0
    assert receiver.counters.frames == 1


GARBAGE = st.lists(st.sampled_from(b"\xfd\xfd\x00\x01\x1e\x84\xcb"), max_size=60).map(bytes)


@settings(max_examples=300)
@given(GARBAGE, st.integers(0, 60))
def test_garbage_is_passed_over_as_if_every_start_were_read(buffer: bytes, position: int) -> None:
    starts = [at for at in range(position, len(buffer)) if buffer[at] == 0xFD]
    worth = [at for at in starts if decode(buffer, at) is not Refusal.UNKNOWN]

    assert next_start(buffer, position) == next(iter(worth), len(buffer))


@settings(max_examples=300)
@given(st.lists(st.binary(max_size=400), max_size=6))
def test_no_bytes_raise_and_little_is_kept(pieces: list[bytes]) -> None:
    receiver = Receiver()
    for piece in pieces:
        receiver.receive(piece)
        assert len(receiver._rest) < 10 + 255 + 2 + 13
    receiver.receive(b"", whole=True)

    assert receiver._rest == b""
