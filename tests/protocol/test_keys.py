"""The key file and the timestamps beside it: private, whole, and never forgotten quietly."""

import itertools
import stat
from pathlib import Path

import pytest

from laglab_protocol import (
    Codec,
    Command,
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
from laglab_protocol.signing.keys import StoredTimestamps, timestamps_path
from laglab_protocol.signing.signature import AHEAD, CLOCK_EVERY, MINUTE, Signer, Verifier

KEY = bytes(range(32))
STREAM = (0, 200, 190)
NOW = 37_000_000_000_000
COMMAND = Command(0.5, -1.0, 7, 1, 1, 0)


def signed(now: int, stream: tuple[int, int, int]) -> bytes:
    return Sender(stream[1], stream[2], Signer(KEY, stream, clock=lambda: now)).frame(COMMAND)


def stamp_of(raw: bytes) -> int:
    return int.from_bytes(raw[-12:-6], "little")


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
    assert again.receiver.receive(b"".join(said), whole=True) == []
    assert again.receiver.counters.refused[Refusal.REPLAYED] == 3


def test_every_stream_is_kept_across_a_second_crash(tmp_path: Path) -> None:
    """One stream that is far ahead does not keep another's place from being written."""
    path, slow, fast = tmp_path / "timestamps", (0, 7, 1), (0, 8, 1)

    def hears(*frames: bytes) -> list[bool]:
        listening = Receiver(Verifier(KEY, StoredTimestamps(path), clock=lambda: NOW))
        return [bool(listening.receive(raw, whole=True)) for raw in frames]

    assert hears(signed(NOW, stream=slow)) == [True]
    late = signed(NOW + 2 * AHEAD, stream=slow)
    assert hears(signed(NOW + MINUTE, stream=fast), late) == [True, True]
    assert hears(late) == [False]


def test_at_the_end_what_is_kept_is_exact(key_file: Path) -> None:
    """So that what is said next is not refused for the second that was written ahead."""
    with Codec(200, 190, key_file) as station, Codec(1, 1, key_file) as robot:
        raw = station.sender.frame(COMMAND)
        assert robot.receiver.receive(raw, whole=True)
    assert StoredTimestamps(timestamps_path(key_file, 1, 1)).last == {STREAM: stamp_of(raw)}


def test_places_that_a_wrong_clock_left_lock_no_new_stream_out(tmp_path: Path) -> None:
    path = tmp_path / "timestamps"
    StoredTimestamps(path).reserve((0, 9, 9), NOW + 10**12)
    listening = Receiver(Verifier(KEY, StoredTimestamps(path), clock=lambda: NOW))

    assert listening.receive(signed(NOW, stream=(1, 7, 1)))


def test_our_own_timestamps_go_on_after_a_restart(tmp_path: Path) -> None:
    path = tmp_path / "timestamps"
    first = StoredTimestamps(path)
    Sender(200, 190, Signer(KEY, STREAM, first, clock=lambda: NOW)).frame(COMMAND)
    again = StoredTimestamps(path)
    raw = Sender(200, 190, Signer(KEY, STREAM, again, clock=lambda: 0)).frame(COMMAND)

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


@pytest.mark.parametrize(
    "text",
    [
        *("[1]", "{", "[" * 100_000, '{"a": 1}'),
        *(f'{{"0/1/1": {last}}}' for last in ('"x"', "null", "Infinity", "1e30", "-5", 2**48 - 1)),
    ],
    ids=range(10),
)
def test_spoiled_timestamps_are_not_forgotten_quietly(tmp_path: Path, text: str) -> None:
    path = tmp_path / "timestamps"
    path.write_text(text)
    with pytest.raises(KeyFileError, match="played again"):
        StoredTimestamps(path)


def test_timestamps_that_cannot_be_kept_are_said(tmp_path: Path) -> None:
    timestamps = StoredTimestamps(tmp_path / "gone" / "timestamps")
    with pytest.raises(KeyFileError, match="cannot keep"):
        timestamps.reserve(STREAM, NOW)


def test_an_open_door_is_refused(key_file: Path) -> None:
    with open_endpoint("udpin://0.0.0.0:0") as outside, open_endpoint("udpin://:0") as inside:
        with pytest.raises(UnsignedLinkError, match="--unsigned"):
            refuse_open_door(outside, None, unsigned_allowed=False)
        refuse_open_door(outside, None, unsigned_allowed=True)
        refuse_open_door(outside, key_file, unsigned_allowed=False)
        refuse_open_door(inside, None, unsigned_allowed=False)


def test_each_link_has_an_id_of_its_own_and_none_hears_what_was_said_on_another(
    tmp_path: Path,
) -> None:
    make_key(tmp_path / "key")
    with Codec(200, 190, tmp_path / "key") as station:
        said = station.sender.frame(COMMAND)
    with Codec(1, 1, tmp_path / "key") as robot:
        links = [(robot.sender, robot.receiver), *(robot.on_another_link() for _ in range(2))]
        assert [sender.frame(COMMAND)[-13] for sender, _ in links] == [0, 1, 2]
        assert [len(receiver.receive(said)) for _, receiver in links] == [1, 0, 0]
        assert links[2][1].counters.refused == {Refusal.REPLAYED: 1}
        latest = links[2][0].frame(COMMAND)
    with Codec(1, 1, tmp_path / "key") as again:
        _, receiver = again.on_another_link()
        assert not receiver.receive(said)
        sender, _ = again.on_another_link()
        assert stamp_of(sender.frame(COMMAND)) > stamp_of(latest)
