"""Only the key's holders are heard, each frame once; what is refused changes nothing."""

import itertools
import stat
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_protocol import (
    Codec,
    Command,
    Heartbeat,
    KeyFileError,
    Receiver,
    Refusal,
    Sender,
    Tick,
    UnsignedLinkError,
    make_key,
    open_endpoint,
    read_key,
    refuse_open_door,
)
from laglab_protocol.frame import SIGNED, encode
from laglab_protocol.generated import laglab as dialect
from laglab_protocol.keys import StoredTimestamps
from laglab_protocol.signing import AHEAD, CLOCK_EVERY, MINUTE, Signer, Timestamps, Verifier

KEY = bytes(range(32))
OTHER_KEY = bytes(32)
STREAM = (0, 200, 190)
NOW = 37_000_000_000_000
COMMAND = Command(0.5, -1.0, 7, 1, 1, 0)
HEARTBEAT = Heartbeat(0, 6, 8, 0, 4, 3)


def signer(now: int = NOW, key: bytes = KEY, stream: tuple[int, int, int] = STREAM) -> Signer:
    return Signer(key, stream, clock=lambda: now)


def signed(now: int = NOW, key: bytes = KEY, stream: tuple[int, int, int] = STREAM) -> bytes:
    return Sender(stream[1], stream[2], signer(now, key, stream)).frame(COMMAND)


class Listening:
    """A receiver whose whole state can be compared."""

    def __init__(self, allow: frozenset[str] = frozenset(), now: int = NOW) -> None:
        self.timestamps = Timestamps()
        self.receiver = Receiver(Verifier(KEY, self.timestamps, allow, clock=lambda: now))

    def hears(self, raw: bytes) -> bool:
        return bool(self.receiver.receive(raw) + self.receiver.end_datagram())

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
    return bytes(dialect.MAVLink_laglab_command_message(*COMMAND).pack(theirs))


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
    "unsigned": (encode(COMMAND, 200, 190, 1), Refusal.UNSIGNED),
    "unsigned, though a heartbeat": (encode(HEARTBEAT, 200, 190, 1), Refusal.UNSIGNED),
    "an unknown incompatibility flag": (encode(COMMAND, 200, 190, 1, 0x02), Refusal.INCOMPATIBLE),
    "signed and another flag": (
        signer().sign(encode(COMMAND, 200, 190, 1, SIGNED | 0x02)),
        Refusal.INCOMPATIBLE,
    ),
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

    assert listening.hears(encode(HEARTBEAT, 200, 190, 0))
    assert not listening.hears(encode(COMMAND, 200, 190, 1))
    bad = Sender(200, 190, signer(key=OTHER_KEY)).frame(HEARTBEAT)
    assert not listening.hears(bad)


def test_without_a_key_what_is_signed_is_not_believed() -> None:
    receiver = Receiver()

    assert receiver.receive(signed()) + receiver.end_datagram() == []
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


# On disk


@pytest.fixture
def key_file(tmp_path: Path) -> Path:
    path = tmp_path / "robot.key"
    make_key(path)
    return path


def test_a_key_is_private_and_random(key_file: Path, tmp_path: Path) -> None:
    make_key(tmp_path / "other.key")

    assert stat.S_IMODE(key_file.stat().st_mode) == 0o600
    assert len(read_key(key_file)) == 32
    assert read_key(key_file) != read_key(tmp_path / "other.key")


def test_a_key_is_not_overwritten(key_file: Path) -> None:
    before = key_file.read_bytes()
    with pytest.raises(KeyFileError, match="exists"):
        make_key(key_file)

    assert key_file.read_bytes() == before


@pytest.mark.parametrize("text", ["", "abcd", "x" * 64, "00" * 33, "é" * 32])
def test_what_is_no_key_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "no.key"
    path.write_text(text)
    path.chmod(0o600)
    with pytest.raises(KeyFileError, match=r"no\.key"):
        read_key(path)


def test_a_key_that_others_may_read_is_refused(key_file: Path) -> None:
    key_file.chmod(0o640)
    with pytest.raises(KeyFileError, match="chmod 600"):
        read_key(key_file)


def test_a_missing_key_is_said(tmp_path: Path) -> None:
    with pytest.raises(KeyFileError, match="No such file"):
        read_key(tmp_path / "no.key")


def test_both_sides_with_one_key_file(key_file: Path) -> None:
    with Codec(1, 1, key_file) as robot, Codec(200, 190, key_file) as station:
        for tick in range(3):
            (frame,) = station.receiver.receive(robot.sender.frame(Tick(tick, 0)))
            assert frame.message == Tick(tick, 0)
            (answer,) = robot.receiver.receive(station.sender.frame(COMMAND))
            assert answer.message == COMMAND


@pytest.mark.parametrize("crash", [False, True])
def test_nothing_is_heard_twice_across_a_restart(key_file: Path, crash: bool) -> None:
    station = Codec(200, 190, key_file)
    said = [station.sender.frame(COMMAND) for _ in range(3)]
    robot = Codec(1, 1, key_file)
    assert len(robot.receiver.receive(b"".join(said))) == 3
    if not crash:
        robot.close()

    again = Codec(1, 1, key_file)
    assert again.receiver.receive(b"".join(said)) + again.receiver.end_datagram() == []
    assert again.receiver.counters.refused[Refusal.REPLAYED] == 3


def test_every_stream_is_kept_across_a_second_crash(tmp_path: Path) -> None:
    """One stream that is far ahead does not keep another's place from being written."""
    path, slow, fast = tmp_path / "timestamps", (0, 7, 1), (0, 8, 1)

    def hears(*frames: bytes) -> list[bool]:
        listening = Receiver(Verifier(KEY, StoredTimestamps(path), clock=lambda: NOW))
        return [bool(listening.receive(raw) + listening.end_datagram()) for raw in frames]

    assert hears(signed(NOW, stream=slow)) == [True]
    late = signed(NOW + 2 * AHEAD, stream=slow)
    assert hears(signed(NOW + 10**8, stream=fast), late) == [True, True]
    assert hears(late) == [False]


def test_our_own_timestamps_go_on_after_a_restart(tmp_path: Path) -> None:
    path = tmp_path / "timestamps"
    first = StoredTimestamps(path)
    Signer(KEY, STREAM, first, clock=lambda: NOW).sign(encode(COMMAND, 200, 190, 0, SIGNED))
    again = StoredTimestamps(path)
    raw = Signer(KEY, STREAM, again, clock=lambda: 0).sign(encode(COMMAND, 200, 190, 0, SIGNED))

    assert NOW < int.from_bytes(raw[-12:-6], "little") <= NOW + AHEAD + 1
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_the_file_is_not_written_for_every_frame(tmp_path: Path) -> None:
    path = tmp_path / "timestamps"
    times = itertools.chain([NOW, NOW + 1], itertools.repeat(NOW + AHEAD + 1))
    sender = Sender(200, 190, Signer(KEY, STREAM, StoredTimestamps(path), lambda: next(times)))
    sender.frame(COMMAND)
    path.unlink()
    sender.frame(COMMAND)
    assert not path.exists()

    said = [sender.frame(COMMAND) for _ in range(3 * CLOCK_EVERY)]
    assert StoredTimestamps(path).last[STREAM] >= stamp_of(said[-1]) > NOW + AHEAD


@pytest.mark.parametrize("text", ["[1]", "{", '{"a": 1}', '{"0/1/1": "x"}'])
def test_spoiled_timestamps_are_not_forgotten_quietly(tmp_path: Path, text: str) -> None:
    path = tmp_path / "timestamps"
    path.write_text(text)
    with pytest.raises(KeyFileError, match="played again"):
        StoredTimestamps(path)


def test_an_open_door_is_refused(key_file: Path) -> None:
    with open_endpoint("udpin://0.0.0.0:0") as outside, open_endpoint("udpin://:0") as inside:
        with pytest.raises(UnsignedLinkError, match="--unsigned"):
            refuse_open_door(outside, None, unsigned_allowed=False)
        refuse_open_door(outside, None, unsigned_allowed=True)
        refuse_open_door(outside, key_file, unsigned_allowed=False)
        refuse_open_door(inside, None, unsigned_allowed=False)
