"""The golden table: what is said, and the very bytes that say it.

Every implementation in these tests, ours and others', must make these bytes of these fields and
these fields of these bytes. The bytes were made by pymavlink and agree with mavgen's C.
"""

import math
from typing import NamedTuple

from msgspec.structs import astuple

from laglab_protocol import (
    NO_PROBE,
    Applied,
    Command,
    End,
    Estimate,
    Heartbeat,
    Measurement,
    Message,
    Probe,
    Recall,
    Settings,
    Tick,
)


class Golden(NamedTuple):
    """One row of the table."""

    name: str
    system: int
    component: int
    sequence: int
    message: Message
    hexadecimal: str

    @property
    def raw(self) -> bytes:
        return bytes.fromhex(self.hexadecimal)


def numbers(message: Message) -> tuple[float, ...]:
    """The fields, those of arrays one by one."""
    fields = [each if isinstance(each, tuple) else (each,) for each in astuple(message)]
    return sum(fields, ())


GOLDEN = [
    Golden(
        "the first tick",
        1,
        1,
        0,
        Tick(0, 0),
        "fd01000000010184cb00005297",
    ),
    Golden(
        "a tick with measurements",
        1,
        1,
        255,
        Tick(4294967295, 255),
        "fd050000ff010184cb00ffffffffffa866",
    ),
    Golden(
        "a measurement",
        1,
        1,
        7,
        Measurement(-2.987, -3.0123, 0.0625, 1.7, -0.3, 130, 119),
        "fd2d000007010185cb004c37894160e507c029ed0dbe301908c0000000000000b03f333333333333"
        "fb3f333333333333d3bf8200000077ddb4",
    ),
    Golden(
        "a measurement before any command",
        1,
        1,
        8,
        Measurement(-3.0, -3.0, 0.0, 0.0, 0.0, 0, -1),
        "fd30000008010185cb0000000000000008c000000000000008c00000000000000000000000000000"
        "0000000000000000000000000000ffffffff9067",
    ),
    Golden(
        "a measurement that is not finite",
        1,
        1,
        9,
        Measurement(math.nan, math.inf, -math.inf, 5e-324, -0.0, 1, -1),
        "fd30000009010185cb00000000000000f87f000000000000f07f000000000000f0ff010000000000"
        "0000000000000000008001000000fffffffffba2",
    ),
    Golden(
        "a command",
        200,
        190,
        16,
        Command(0.25, -1.5, 30, 1, 1, 1),
        "fd17000010c8be86cb00000000000000d03f000000000000f8bf1e0000000101015084",
    ),
    Golden(
        "a command to stand still",
        200,
        190,
        17,
        Command(0.0, 0.0, 31, 1, 1, 0),
        "fd16000011c8be86cb00000000000000000000000000000000001f0000000101819d",
    ),
    Golden(
        "an estimate",
        200,
        190,
        18,
        Estimate(-2.9, -2.8, 0.7, 0.0001, -2e-06, 3e-06, 0.00011, -4e-06, 0.00018, 30),
        "fd49000012c8be87cb0033333333333307c066666666666606c0666666666666e63f2d431cebe236"
        "1a3f8dedb5a0f7c6c0be54e41071732ac93e4bb0389cf9d51c3f8dedb5a0f7c6d0be0fd6ff39cc97"
        "273f1e1f3e",
    ),
    Golden(
        "an estimate that diverged",
        200,
        190,
        19,
        Estimate(
            1.7976931348623157e308,
            math.nan,
            0.0,
            math.inf,
            0.0,
            0.0,
            math.inf,
            0.0,
            math.inf,
            4000000000,
        ),
        "fd4c000013c8be87cb00ffffffffffffef7f000000000000f87f0000000000000000000000000000"
        "f07f00000000000000000000000000000000000000000000f07f0000000000000000000000000000"
        "f07f00286bee30fc",
    ),
    Golden(
        "the end, all zero",
        1,
        1,
        20,
        End(0, 0),
        "fd01000014010188cb00000d31",
    ),
    Golden(
        "the end of a failed run",
        200,
        190,
        21,
        End(1000, 3),
        "fd05000015c8be88cb00e8030000039fc7",
    ),
    Golden(
        "a station's settings",
        200,
        190,
        22,
        Settings(0.01, 0.05, 0.6, 1.0, 1.7, 10, 20, 2),
        "fd2d000016c8be89cb007b14ae47e17a843f9a9999999999a93f333333333333e33f000000000000"
        "f03f333333333333fb3f0a00140002aeff",
    ),
    Golden(
        "a robot that knows little",
        1,
        1,
        23,
        Settings(0.02, math.nan, math.nan, math.inf, math.inf, 65535, 65535, 2),
        "fd2d000017010189cb007b14ae47e17a943f000000000000f87f000000000000f87f000000000000"
        "f07f000000000000f07fffffffff02bb1b",
    ),
    Golden(
        "which speeds were in force?",
        200,
        190,
        24,
        Recall(4000000000, 1024, 1, 1),
        "fd08000018c8be8acb0000286bee000401011179",
    ),
    Golden(
        "these, and one that nobody knows any more",
        1,
        1,
        25,
        Applied(
            (0.1, -1.7, math.nan, *(0.0,) * 9),
            (-0.0, 0.3, math.nan, *(0.0,) * 9),
            4000000000,
            3,
        ),
        "fdc500001901018bcb009a9999999999b93f333333333333fbbf000000000000f87f000000000000"
        "00000000000000000000000000000000000000000000000000000000000000000000000000000000"
        "00000000000000000000000000000000000000000000000000000000000000000080333333333333"
        "d33f000000000000f87f000000000000000000000000000000000000000000000000000000000000"
        "00000000000000000000000000000000000000000000000000000000000000000000000000000000"
        "000000286bee0316ac",
    ),
    Golden(
        "a probe of the link",
        200,
        190,
        26,
        Probe(
            1700000000123456789,
            (1700000000000000000, 1699999999000000000, 0),
            0xDEADBEEF,
            1000,
            10000,
            (999, 983, NO_PROBE),
            (1, 1, 1, *(0,) * 177),
        ),
        "fd3b00001ac8be8ecb0015cd853dfe9c971700002a36fe9c971700368ffafd9c9717000000000000"
        "0000efbeaddee803000010270000e7030000d7030000ffffffff0101019b2c",
    ),
    Golden(
        "a rover's heartbeat",
        1,
        1,
        22,
        Heartbeat(0, 10, 0, 0, 4, 3),
        "fd090000160101000000000000000a000004030576",
    ),
]
