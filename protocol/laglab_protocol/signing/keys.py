"""The key file, and what has been said with the key, kept across restarts."""

import itertools
import json
import os
import secrets
import stat
from contextlib import suppress
from pathlib import Path

from laglab_protocol.endpoints import Endpoint
from laglab_protocol.errors import KeyFileError, UnsignedLinkError
from laglab_protocol.framing.receiver import Receiver
from laglab_protocol.framing.sender import Sender
from laglab_protocol.signing.signature import (
    AHEAD,
    KEY_SIZE,
    MINUTE,
    Place,
    Signer,
    Stream,
    Timestamps,
    Verifier,
)

LATEST = (1 << 48) - MINUTE
"""A timestamp, in 2104: six bytes hold what follows for a minute more."""


def make_key(path: Path) -> None:
    """Write a new random key to `path`, readable by its owner only.

    Raises KeyFileError when `path` exists (a key is not to be lost) or cannot be written.
    """
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except OSError as error:
        raise KeyFileError(f"cannot make the key {path}: {error.strerror}") from error
    try:
        with os.fdopen(descriptor, "w") as file:
            file.write(secrets.token_hex(KEY_SIZE) + "\n")
    except OSError as error:
        path.unlink()
        raise KeyFileError(f"cannot make the key {path}: {error.strerror}") from error


def read_key(path: Path) -> bytes:
    """The key in the file. Raises KeyFileError when it is not there, not private or no key."""
    try:
        mode, text = path.stat().st_mode, path.read_text(encoding="ascii")
        key = bytes.fromhex(text)
    except OSError as error:
        raise KeyFileError(f"cannot read the key {path}: {error.strerror}") from error
    except ValueError as error:
        raise KeyFileError(f"{path} is no key: it must hold 64 hexadecimal digits") from error
    if len(key) != KEY_SIZE:
        raise KeyFileError(f"{path} is no key: {len(key)} bytes instead of {KEY_SIZE}")
    if os.name == "posix" and mode & (stat.S_IRWXG | stat.S_IRWXO):  # elsewhere it says nothing
        raise KeyFileError(f"others may read the key {path}: run chmod 600 on it, or make another")
    return key


class StoredTimestamps(Timestamps):
    """Timestamps that survive: the file is at all times at or ahead of what has been accepted.

    It is written a second ahead, so that it need not be for every frame; after a crash the other
    side is refused for at most that long.
    """

    def __init__(self, path: Path) -> None:
        """Raises KeyFileError when the file is there and does not hold timestamps."""
        super().__init__()
        self._path = path
        try:
            stored = json.loads(path.read_text()) if path.exists() else {}
            self.places = {
                _stream(name): Place(_timestamp(last), 0) for name, last in stored.items()
            }
        except (OSError, ValueError, TypeError, AttributeError, RecursionError) as error:
            raise KeyFileError(
                f"{path} does not hold the timestamps of a key: {error}; without them old frames "
                "could be played again: restore it, or make a new key for both sides"
            ) from error
        self._written = self.last

    def reserve(self, stream: Stream, timestamp: int) -> int:
        self._written[stream] = timestamp + AHEAD
        self._write()
        return timestamp + AHEAD

    def close(self) -> None:
        """From here on the file is exact, or where it cannot be written still ahead: no less
        safe, and for a second a restarted side is refused."""
        self._written = self.last
        with suppress(KeyFileError):
            self._write()

    def _write(self) -> None:
        named = {"/".join(map(str, stream)): value for stream, value in self._written.items()}
        try:
            _replace(self._path, json.dumps(named))
        except OSError as error:
            raise KeyFileError(
                f"cannot keep the timestamps {self._path}: {error.strerror}; without them old "
                "frames could be played again: make room, or let this user write there"
            ) from error


def _replace(path: Path, text: str) -> None:
    """Whole or not at all, and for the owner only."""
    beside = path.with_name(path.name + ".new")
    with os.fdopen(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as file:
        file.write(text)
    beside.replace(path)


def _stream(name: str) -> Stream:
    link, system, component = map(int, name.split("/"))
    return link, system, component


def _timestamp(told: object) -> int:
    """As it was kept. Raises ValueError: it is none that could be counted on from."""
    if type(told) is not int or not 0 <= told < LATEST:
        raise ValueError(f"{told!r} is no timestamp")
    return told


def timestamps_path(key_file: Path, system: int, component: int) -> Path:
    """Where one side keeps its timestamps: beside the key, which both sides may share."""
    return key_file.with_name(f"{key_file.name}.{system}-{component}.timestamps")


class Codec:
    """A sender and a receiver for one (system, component), signed when there is a key file.

    A context manager: at its end the last timestamps are on disk. Raises KeyFileError.
    """

    def __init__(self, system: int, component: int, key_file: Path | None = None) -> None:
        self._speaker = system, component
        self._key = read_key(key_file) if key_file else None
        self._timestamps = Timestamps()
        if key_file:
            self._timestamps = StoredTimestamps(timestamps_path(key_file, system, component))
        self._link_ids = itertools.count()
        self.sender, self.receiver = self.on_another_link()

    def on_another_link(
        self, allow_unsigned: frozenset[str] = frozenset()
    ) -> tuple[Sender, Receiver]:
        """For one more link: its frames are numbered apart; what was said on one counts on all.

        `allow_unsigned` names the messages that need no signature there.
        """
        link_id = next(self._link_ids)
        if self._key is None:
            return Sender(*self._speaker), Receiver()
        signer = Signer(self._key, (link_id, *self._speaker), self._timestamps)
        verifier = Verifier(self._key, self._timestamps, allow_unsigned)
        return Sender(*self._speaker, signer), Receiver(verifier)

    def close(self) -> None:
        self._timestamps.close()

    def __enter__(self) -> "Codec":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def refuse_open_door(
    endpoint: Endpoint,
    key_file: Path | None,
    unsigned_allowed: bool,
    option: str = "--key",
    harm: str = "move the robot",
) -> None:
    """Raise UnsignedLinkError when strangers can reach `endpoint` and no key keeps them out.

    `option` is where that key is given, `harm` is what strangers could do.
    """
    if not (endpoint.loopback or key_file or unsigned_allowed):
        raise UnsignedLinkError(
            f"{endpoint.name} can be reached from outside, and without a key anybody there can "
            f"{harm}: give {option} FILE (laglab protocol keygen makes one), or say "
            "--unsigned"
        )
