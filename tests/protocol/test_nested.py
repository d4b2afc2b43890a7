"""Packet in packet: a frame inside one that was refused is counted apart, and refused by default
where there is no key and the outer frame was whole."""

from dataclasses import replace

import pytest

from laglab_conformance.forge import Forged
from laglab_protocol import Command, Receiver, Refusal, Sender, Tick, message_type
from laglab_protocol.signing.signature import Signer, Verifier

KEY, OTHER_KEY = bytes(range(32)), bytes(32)
INNER = Sender(200, 190).frame(Command(9.0, 9.0, 7, 1, 1, 0))
TUNNEL = message_type("ENCAPSULATED_DATA")
NEXT = Sender(1, 1).frame(Tick(8, 0))


def outer(inner: bytes, signer: Signer | None = None) -> Forged:
    """A frame of somebody's who may choose what is in it: a whole frame."""
    data = inner + b"\x01" * (253 - len(inner))
    return Forged.of(TUNNEL(1, tuple(data)), 7, 7, 0, signer)


REFUSED = {
    "a bit of its CRC flipped": replace(outer(INNER), crc_flip=0x10).raw,
    "of a dialect that we do not know": replace(outer(INNER), message_id=60000).raw,
    "an unknown flag": replace(outer(INNER), incompatibility=0x02).raw,
    "signed": outer(INNER, Signer(OTHER_KEY, (0, 7, 7))).raw,
}


@pytest.mark.parametrize("name", REFUSED)
@pytest.mark.parametrize("datagram", [True, False])
def test_a_frame_inside_one_that_was_refused_is_not_delivered(name: str, datagram: bool) -> None:
    receiver = Receiver()
    received = receiver.receive(REFUSED[name] + NEXT, whole=datagram)

    assert [frame.message for frame in received] == [Tick(8, 0)]
    assert receiver.counters.refused[Refusal.NESTED] == 1
    assert receiver.counters.nested == 0


@pytest.mark.parametrize("name", REFUSED)
def test_whoever_wants_it_all_the_same_is_told_how_many(name: str) -> None:
    receiver = Receiver(nested=True)

    assert len(receiver.receive(REFUSED[name] + NEXT, whole=True)) == 2
    assert receiver.counters.nested == 1


def test_in_pieces_it_is_refused_too() -> None:
    receiver = Receiver()
    stream = NEXT + REFUSED["a bit of its CRC flipped"] + NEXT
    received = [frame for byte in stream for frame in receiver.receive(bytes([byte]))]

    assert len(received) == 2
    assert receiver.counters.refused[Refusal.NESTED] == 1


def test_with_a_key_what_is_inside_is_signed_or_nothing() -> None:
    ours = Sender(200, 190, Signer(KEY, (0, 200, 190)))
    frame = ours.frame(Command(1.0, 0.0, 7, 1, 1, 0))
    receiver = Receiver(Verifier(KEY))

    assert len(receiver.receive(replace(outer(frame), crc_flip=1).raw + NEXT, whole=True)) == 1
    assert receiver.receive(replace(outer(INNER), crc_flip=1).raw, whole=True) == []
    assert receiver.counters.nested == 1


def test_a_false_start_is_no_outer_frame() -> None:
    """What is cut off, or stands in garbage, hides nothing; what was found inside is counted."""
    receiver = Receiver()
    cut_off = REFUSED["a bit of its CRC flipped"][:-40]

    assert len(receiver.receive(cut_off, whole=True)) == 1
    assert len(receiver.receive(b"?" + REFUSED["a bit of its CRC flipped"] + b"?", whole=True)) == 1
    assert receiver.counters.nested == 2
