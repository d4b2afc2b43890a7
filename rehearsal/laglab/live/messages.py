"""What the loop and the live page's process say to each other, over UDP on loopback.

A datagram: the secret that both were told, then the message. The loop never waits: what finds no
room is lost, and the page has a gap.
"""

import socket
from contextlib import suppress
from typing import Literal, NamedTuple

import msgspec
from msgspec import Struct

from laglab_gateway import ArrivalRow, ClaimRow, LinkRow, TimingRow, TraceRow

LARGEST = 60_000
"""[byte]"""
Order = Literal["stop", "end"]


class Rows(Struct, tag="rows"):
    """What has happened since the last of these; of what comes faster than a screen shows, some."""

    trace: list[TraceRow] = []
    arrivals: list[ArrivalRow] = []
    claims: list[ClaimRow] = []
    link: list[LinkRow] = []
    timing: list[TimingRow] = []
    frames: list[bytes] = []
    """Those that say something in words; of a station alone, which has no rows, all."""
    stopped: bool = False
    """Whether the robot was stopped for good."""


class Over(Struct, tag="over"):
    """The run is over."""

    verdict: str


class Given(Struct, tag="given"):
    """What somebody at the page wants of the loop; repeated until it is done."""

    order: Order


Message = Rows | Over | Given
_encode = msgspec.msgpack.Encoder().encode
_decode = msgspec.msgpack.Decoder(Message).decode


class LiveOrder(Struct, frozen=True):
    """What a live page is of, and where it is to be."""

    scenario: str
    """As TOML."""
    host: str
    port: int
    token: str
    secret: str
    station_alone: bool
    measured: bool
    """Whether nobody knows the true pose, as of a real robot."""
    origin: str
    """What was run, in a line."""


class Line(NamedTuple):
    """Where the page's process listens on loopback, and the secret by which it knows us."""

    port: int
    secret: str

    @classmethod
    def read(cls, text: str) -> "Line":
        """What `str` wrote."""
        port, _, secret = text.partition(":")
        return cls(int(port), secret)

    def __str__(self) -> str:
        return f"{self.port}:{self.secret}"


def packed(message: Message, secret: str) -> bytes:
    """A datagram."""
    return secret.encode() + _encode(message)


def unpacked(data: bytes, secret: str) -> Message | None:
    """What a datagram says; None when it is not from one who was told the secret."""
    told = secret.encode()
    if not data.startswith(told):
        return None
    try:
        message: Message = _decode(memoryview(data)[len(told) :])
    except msgspec.DecodeError:
        return None
    return message


class Caller:
    """The loop's end, or that of whoever started it."""

    def __init__(self, line: Line) -> None:
        self._secret = line.secret
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(("127.0.0.1", line.port))
        self._socket.setblocking(False)

    def say(self, message: Message) -> bool:
        """Now or never; False when it was never."""
        data = packed(message, self._secret)
        if len(data) > LARGEST:
            return False
        with suppress(OSError):  # nobody there, or no room
            return self._socket.send(data) == len(data)
        return False

    def heard(self) -> Order | None:
        """What was ordered, if anything was."""
        with suppress(OSError):
            match unpacked(self._socket.recv(256), self._secret):
                case Given(order):
                    return order
        return None

    def close(self) -> None:
        """Nothing more is said."""
        self._socket.close()
