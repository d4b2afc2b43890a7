"""Only the key's holders are heard, each frame once; what is refused changes nothing."""

import itertools
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import astuple

from laglab_conformance.forge import Forged
from laglab_protocol import STATION_HEARTBEAT, Command, Receiver, Refusal, Sender
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.framing.frame import SIGNED
from laglab_protocol.signing.signature import CLOCK_EVERY, MINUTE, Signer, Timestamps, Verifier

from .encoding import encode

KEY = bytes(range(32))
OTHER_KEY = bytes(32)
STREAM = (0, 200, 190)
NOW = 37_000_000_000_000
COMMAND = Command(0.5, -1.0, 7, 1, 1, 0)


def signer(now: int = NOW, key: bytes = KEY, stream: tuple[int, int, int] = STREAM) -> Signer:
    return Signer(key, stream, clock=lambda: now)


def signed(now: int = NOW, key: bytes = KEY, stream: tuple[int, int, int] = STREAM) -> bytes:
    return Sender(stream[1], stream[2], signer(now, key, stream)).frame(COMMAND)


def flagged(flags: int, signer: Signer | None = None) -> bytes:
    return replace(Forged.of(COMMAND, 200, 190, 1, signer), incompatibility=flags).raw


class Listening:
    """A receiver whose whole state can be compared."""

    def __init__(self, allow: frozenset[str] = frozenset(), now: int = NOW) -> None:
        self.timestamps = Timestamps()
        self.receiver = Receiver(Verifier(KEY, self.timestamps, allow, clock=lambda: now))

    def hears(self, raw: bytes) -> bool:
        return bool(self.receiver.receive(raw, whole=True))

    @property
    def state(self) -> tuple[Any, ...]:
        counters = self.receiver.counters
        following = dict(self.receiver._expected)
        return dict(self.timestamps.last), following, counters.lost, counters.late, counters.frames


def pymavlink_signed(timestamp: int) -> bytes:
    theirs = dialect.MAVLink(None, 200, 190)
    theirs.signing.secret_key = KEY
    theirs.signing.sign_outgoing = True
    theirs.signing.timestamp = timestamp
    return bytes(dialect.MAVLink_laglab_command_message(*astuple(COMMAND)).pack(theirs))


def test_pymavlink_signs_the_same_bytes() -> None:
    assert pymavlink_signed(NOW) == signed()


def test_what_pymavlink_signs_is_heard() -> None:
    assert Listening().hears(pymavlink_signed(NOW))


def test_pymavlink_hears_what_we_sign() -> None:
    theirs = dialect.MAVLink(None, 1, 1)
    theirs.signing.secret_key = KEY
    (read,) = theirs.parse_buffer(signed())

    assert read.get_signed()


REJECTS = {
    "another key": (signed(key=OTHER_KEY), Refusal.BAD_SIGNATURE),
    "a forged later timestamp": (
        signed(NOW + 10)[:-12] + (NOW + 10**9).to_bytes(6, "little") + signed(NOW + 10)[-6:],
        Refusal.BAD_SIGNATURE,
    ),
    "a forged link": (
        signed(NOW + 10)[:-13] + b"\7" + signed(NOW + 10)[-12:],
        Refusal.BAD_SIGNATURE,
    ),
    "the same again": (signed(), Refusal.REPLAYED),
    "earlier": (signed(NOW - 1), Refusal.REPLAYED),
    "a new stream an hour old": (signed(NOW - 60 * MINUTE, stream=(3, 9, 9)), Refusal.REPLAYED),
    "a clock in 2050": (signed(NOW + 10**10), Refusal.AHEAD),
    "a new stream with a clock in 2050": (signed(NOW + 10**10, stream=(3, 9, 9)), Refusal.AHEAD),
    "unsigned": (encode(COMMAND, 200, 190, 1), Refusal.UNSIGNED),
    "unsigned, though a heartbeat": (encode(STATION_HEARTBEAT, 200, 190, 1), Refusal.UNSIGNED),
    "an unknown incompatibility flag": (flagged(0x02), Refusal.INCOMPATIBLE),
    "signed and another flag": (flagged(SIGNED | 0x02, signer()), Refusal.INCOMPATIBLE),
}


@pytest.mark.parametrize("name", REJECTS)
def test_rejected_with_no_state_changed(name: str) -> None:
    raw, refusal = REJECTS[name]
    listening = Listening()
    assert listening.hears(signed())
    before = listening.state

    assert not listening.hears(raw)
    assert listening.receiver.counters.refused[refusal] == 1
    assert listening.state == before
    assert listening.hears(signed(NOW + 1))


def test_mavlink_1_is_never_heard() -> None:
    theirs = dialect.MAVLink(None, 200, 190)
    old = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(theirs, force_mavlink1=True)
    listening = Listening(frozenset({"HEARTBEAT"}))
    before = listening.state

    assert not listening.hears(bytes(old))
    assert listening.state == before


def test_unsigned_passes_by_name_only() -> None:
    listening = Listening(frozenset({"HEARTBEAT"}))

    assert listening.hears(encode(STATION_HEARTBEAT, 200, 190, 0))
    assert not listening.hears(encode(COMMAND, 200, 190, 1))
    bad = Sender(200, 190, signer(key=OTHER_KEY)).frame(STATION_HEARTBEAT)
    assert not listening.hears(bad)


def test_without_a_key_what_is_signed_is_not_believed() -> None:
    receiver = Receiver()

    assert receiver.receive(signed(), whole=True) == []
    assert receiver.counters.refused[Refusal.NO_KEY] == 1


@given(st.integers(0, 8 * 60), st.integers(1, 255))
def test_any_flipped_bit_is_refused(bit: int, mask: int) -> None:
    raw = bytearray(signed(NOW + 10))
    raw[bit % len(raw)] ^= mask
    listening = Listening()
    listening.hears(signed())
    before = listening.state

    assert not listening.hears(bytes(raw))
    assert listening.state == before


def test_streams_are_told_apart() -> None:
    listening = Listening()

    assert listening.hears(signed(NOW, stream=(0, 200, 190)))
    assert listening.hears(signed(NOW - 5, stream=(1, 200, 190)))
    assert listening.hears(signed(NOW - 5, stream=(0, 201, 190)))
    assert listening.hears(signed(NOW - 5, stream=(0, 200, 191)))


@pytest.mark.parametrize(("behind", "heard"), [(MINUTE - 1, True), (MINUTE, False)])
def test_a_new_stream_may_be_a_minute_behind(behind: int, heard: bool) -> None:
    assert Listening().hears(signed(NOW - behind)) is heard


@pytest.mark.parametrize(("ahead", "heard"), [(MINUTE, True), (MINUTE + 1, False)])
def test_a_stream_may_be_a_minute_ahead(ahead: int, heard: bool) -> None:
    listening = Listening()
    assert listening.hears(signed(NOW + ahead)) is heard
    assert listening.hears(signed(NOW + 1, stream=(9, 9, 9))), "and locks no other out"


def stamp_of(raw: bytes) -> int:
    return int.from_bytes(raw[-12:-6], "little")


def test_timestamps_grow_even_when_the_clock_goes_back() -> None:
    times = itertools.cycle([NOW, NOW - 10**6, NOW + 5])
    sender = Sender(200, 190, Signer(KEY, STREAM, clock=lambda: next(times)))
    stamps = [stamp_of(sender.frame(COMMAND)) for _ in range(100)]

    assert stamps[0] == NOW
    assert all(later > earlier for earlier, later in itertools.pairwise(stamps))


def test_timestamps_follow_the_clock() -> None:
    times = itertools.count(NOW, 1000)
    sender = Sender(200, 190, Signer(KEY, STREAM, clock=lambda: next(times)))
    stamps = [stamp_of(sender.frame(COMMAND)) for _ in range(10 * CLOCK_EVERY + 1)]

    assert stamps[-1] >= NOW + 10 * 1000


def test_no_timestamp_is_used_that_was_not_reserved() -> None:
    """However little is reserved at a time: what is kept on disk is never behind what was said."""

    class Stingy(Timestamps):
        promised = 0

        def reserve(self, stream: tuple[int, int, int], timestamp: int) -> int:
            del stream
            self.promised = timestamp + 2
            return self.promised

    timestamps = Stingy()
    speaking = Sender(200, 190, Signer(KEY, (0, 200, 190), timestamps, clock=lambda: 10**12))
    for _ in range(50):
        raw = speaking.frame(COMMAND)
        assert int.from_bytes(raw[-12:-6], "little") <= timestamps.promised
