"""How fast the codec is, beside pymavlink's and mavgen's C on the same messages."""

import ctypes
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from laglab.bench.harness import Bench, Contest, Turn, microseconds, timed
from laglab.c_library import c_library, new_folder
from laglab_protocol import Measurement, Receiver, Sender, Signer, Verifier
from laglab_protocol.dialect.generated import laglab as pymavlink
from laglab_protocol.dialect.mavgen import dialect_path, generate

FIELDS = (1.5, -2.0, 3.125, 0.5, -1.7, 1_234_567, 1_234_537)
"""The fields of a LAGLAB_MEASUREMENT, whose frame has 60 bytes."""
BLOCK = 500
KEY = bytes(range(32))
NAMES = ("ours", "pymavlink", "mavgen's C")


def bench(stack: ExitStack) -> Bench:
    """Encode from fields to bytes, decode from bytes to fields, unsigned and signed.

    Raises:
        BuildError: the C does not compile, or there is no compiler.
    """
    c = _compiled(stack)
    cases = {
        "encode": _encoders(c, signed=False),
        "decode": _decoders(c, signed=False),
        "encode signed": _encoders(c, signed=True),
        "decode signed": _decoders(c, signed=True),
    }
    return Bench("codec", [Contest("one message", microseconds("message"), NAMES[0], cases)])


Block = Callable[[], None]
"""Encodes or decodes BLOCK messages."""


def _encoders(c: ctypes.CDLL, signed: bool) -> dict[str, Turn]:
    return _turns(_encode_ours(signed), _encode_theirs(signed), _encode_c(c, signed))


def _decoders(c: ctypes.CDLL, signed: bool) -> dict[str, Turn]:
    return _turns(_decode_ours(signed), _decode_theirs(signed), _decode_c(c, signed))


def _turns(ours: Block, theirs: Block, c: Block) -> dict[str, Turn]:
    return {name: timed(block, BLOCK) for name, block in zip(NAMES, (ours, theirs, c), strict=True)}


def _sender(signed: bool) -> Sender:
    return Sender(1, 1, Signer(KEY, (0, 1, 1)) if signed else None)


def _encode_ours(signed: bool) -> Block:
    sender = _sender(signed)

    def block() -> None:
        for _ in range(BLOCK):
            sender.frame(Measurement(*FIELDS))

    return block


def _decode_ours(signed: bool) -> Block:
    sender = _sender(signed)
    frames = [sender.frame(Measurement(*FIELDS)) for _ in range(BLOCK)]

    def block() -> None:
        receiver = Receiver(Verifier(KEY) if signed else None)
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


def _compiled(stack: ExitStack) -> ctypes.CDLL:
    headers = new_folder(stack)
    generate(dialect_path(), "C", headers)
    library = c_library(Path(__file__).with_name("codec.c"), {}, stack, headers)
    library.use_key(KEY)
    return library


def _encode_c(c: ctypes.CDLL, signed: bool) -> Block:
    return lambda: c.encode(BLOCK, signed)


def _decode_c(c: ctypes.CDLL, signed: bool) -> Block:
    c.encode(BLOCK, signed)

    def block() -> None:
        assert c.decode(BLOCK, signed) == BLOCK

    return block
