"""How long what a tick sends is, and probes as long as that."""

import re
from typing import NamedTuple

from laglab_protocol import (
    BITS_PER_BYTE,
    NO_PROBE,
    PROBE_FILLER,
    PROBE_LAGS,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    Command,
    Estimate,
    Measurement,
    Message,
    Probe,
    Sender,
    Tick,
)

TICK = 1000
"""What is said at this tick is as long as at most others: small numbers travel in fewer bytes."""
BAUD = re.compile(r"^(?:serial:|/).*[:,](\d+)$")
NONE = (NO_PROBE,) * len(PROBE_LAGS)
NEVER = (0,) * len(PROBE_LAGS)
SAID_BY_THE_ROBOT: tuple[Message, ...] = (
    Measurement(0.1, 0.1, 0.1, 0.1, 0.1, TICK, TICK),
    Tick(TICK, 1),
)
SAID_BY_THE_STATION: tuple[Message, ...] = (
    Estimate(*(0.1,) * 9, TICK),
    Command(0.1, 0.1, TICK, ROBOT_SYSTEM, ROBOT_COMPONENT, 1),
)


class Sizes(NamedTuple):
    """What each side says in one tick [byte]."""

    command: int
    measurement: int


def real_sizes(sender: Sender) -> Sizes:
    """Of a tick's datagrams, framed as `sender` frames, signed or not."""
    other = sender.sibling()
    station, robot = (
        sum(len(other.frame(message)) for message in said)
        for said in (SAID_BY_THE_STATION, SAID_BY_THE_ROBOT)
    )
    return Sizes(station, robot)


def filler_for(sender: Sender, size: int) -> tuple[int, ...]:
    """The filler that makes a probe of this sender `size` [byte] long, as nearly as it can."""
    shortest = len(sender.sibling().frame(Probe(0, NEVER, 0, 0, 0, NONE, _ones(0))))
    return _ones(min(max(size - shortest, 0), PROBE_FILLER))


def _ones(count: int) -> tuple[int, ...]:
    return (1,) * count + (0,) * (PROBE_FILLER - count)


def overload(url: str, sizes: Sizes, interval: float) -> str | None:
    """Says in a line that a serial port carries less than such frames need; None where it carries
    them, or is no serial port."""
    match = BAUD.search(url)
    fullest = max(sizes) * BITS_PER_BYTE / interval
    if match is None or fullest <= int(match[1]):
        return None
    return (
        f"{match[1]} baud carry less than the {fullest:.0f} that frames of {max(sizes)} bytes take "
        f"every {1e3 * interval:g} ms: they will wait longer and longer, as a run's would"
    )
