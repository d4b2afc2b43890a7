"""How fast the codec is, beside pymavlink's and mavgen's C on the same messages, in one run.

The three take turns in short blocks, and of each the fastest block counts: what else the machine
does falls on all alike and drops out of the ratios.
"""

import itertools
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from laglab_fmu import c_compiler
from laglab_protocol.dialect.generated import laglab as pymavlink
from laglab_protocol.dialect.mavgen import dialect_path, generate
from laglab_protocol.framing.receiver import Receiver
from laglab_protocol.framing.sender import Sender
from laglab_protocol.messages.loop import Measurement
from laglab_protocol.signing.signature import Signer, Verifier

FIELDS = (1.5, -2.0, 3.125, 0.5, -1.7, 1_234_567, 1_234_537)
"""Of a LAGLAB_MEASUREMENT: a frame of 60 bytes."""
BLOCK = 500
C_PROGRAM = Path(__file__).with_suffix(".c")
C_FLAGS = (
    "-std=c99",
    "-D_POSIX_C_SOURCE=199309L",
    "-O2",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Werror",
)
KEY = bytes(range(32))


class Row(NamedTuple):
    """Microseconds a message."""

    what: str
    ours_us: float
    pymavlink_us: float
    c_us: float

    @property
    def times_faster(self) -> float:
        """Than pymavlink."""
        return self.pymavlink_us / self.ours_us

    def __str__(self) -> str:
        return (
            f"{self.what:16} ours {self.ours_us:5.2f} us   pymavlink {self.pymavlink_us:5.2f} us   "
            f"{self.times_faster:4.1f} times faster   C {self.c_us:5.2f} us"
        )


def bench_codec(rounds: int = 100) -> list[Row]:
    """Encode from fields to bytes, decode from bytes to fields, unsigned and signed."""
    c = _bench_c()
    return [
        _row("encode", rounds, _encode_ours(None), _encode_theirs(signed=False), c[0]),
        _row("decode", rounds, _decode_ours(None), _decode_theirs(signed=False), c[1]),
        _row("encode signed", rounds, _encode_ours(KEY), _encode_theirs(signed=True), c[2]),
        _row("decode signed", rounds, _decode_ours(KEY), _decode_theirs(signed=True), c[3]),
    ]


Block = Callable[[], None]


def _row(what: str, rounds: int, ours: Block, theirs: Block, c_us: float) -> Row:
    best = {ours: float("inf"), theirs: float("inf")}
    for block in itertools.islice(itertools.cycle(best), 2 * rounds):
        started = time.perf_counter()
        block()
        best[block] = min(best[block], time.perf_counter() - started)
    return Row(what, best[ours] / BLOCK * 1e6, best[theirs] / BLOCK * 1e6, c_us)


def _encode_ours(key: bytes | None) -> Block:
    sender = Sender(1, 1, Signer(key, (0, 1, 1)) if key else None)

    def block() -> None:
        for _ in range(BLOCK):
            sender.frame(Measurement(*FIELDS))

    return block


def _decode_ours(key: bytes | None) -> Block:
    sender = Sender(1, 1, Signer(key, (0, 1, 1)) if key else None)
    frames = [sender.frame(Measurement(*FIELDS)) for _ in range(BLOCK)]

    def block() -> None:
        receiver = Receiver(Verifier(key) if key else None)
        assert sum(len(receiver.receive(frame)) for frame in frames) == BLOCK

    return block


def _theirs(signed: bool) -> pymavlink.MAVLink:
    mav = pymavlink.MAVLink(None, 1, 1)
    if signed:
        mav.signing.secret_key = KEY
        mav.signing.sign_outgoing = True
        mav.signing.timestamp = 1
    return mav


def _encode_theirs(signed: bool) -> Block:
    mav = _theirs(signed)

    def block() -> None:
        for _ in range(BLOCK):
            pymavlink.MAVLink_laglab_measurement_message(*FIELDS).pack(mav)

    return block


def _decode_theirs(signed: bool) -> Block:
    mav = _theirs(signed)
    frames = [pymavlink.MAVLink_laglab_measurement_message(*FIELDS).pack(mav) for _ in range(BLOCK)]

    def block() -> None:
        parser = _theirs(signed)
        assert sum(len(parser.parse_buffer(frame)) for frame in frames) == BLOCK

    return block


def _bench_c() -> list[float]:
    """Encode, decode, the same signed in mavgen's C [us]: -O2."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        generate(dialect_path(), "C", folder / "include")
        program = folder / "bench"
        flags = [*C_FLAGS, "-isystem", str(folder / "include")]
        subprocess.run([*c_compiler(), *flags, str(C_PROGRAM), "-o", str(program)], check=True)
        told = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return [float(microseconds) for microseconds in told.split()]
