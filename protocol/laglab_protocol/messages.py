"""The messages as NamedTuples, fields in the order in which they travel, named as in the XML.

Those that this project handles are written out, so that a type checker knows their fields; every
other message of the dialect is had by `message_type("NAME")`. Integer fields take ints, float and
double fields floats, text fields bytes (without the zero bytes that pad them), arrays tuples.
Fields that a message gained later (MAVLink 2 extensions) default to 0, as a receiver reads them.
"""

from collections import namedtuple
from enum import IntEnum
from typing import Any, NamedTuple

from laglab_protocol.errors import DialectError
from laglab_protocol.generated import laglab as dialect
from laglab_protocol.standard import STANDARD

Message = tuple[Any, ...]
"""Any message: a class of this module or of `standard`, or one that `message_type` returns."""

NO_COMMAND = -1
"""Measurement.command_tick when no command had come into force."""

UNANNOUNCED = 256
"""More frames than LAGLAB_TICK or LAGLAB_COMMAND can announce: so many are never asked for."""

ROBOT_SYSTEM, ROBOT_COMPONENT = 1, 1
STATION_SYSTEM, STATION_COMPONENT = 200, 190


class EndReason(IntEnum):
    """Why a run ended (LAGLAB_END_REASON)."""

    COMPLETED = 0
    DIVERGED = 1
    INTERRUPTED = 2
    FAILED = 3


class Tick(NamedTuple):
    """Robot: tick k has begun; so many measurements precede this message in its datagram."""

    tick: int
    measurements: int


class Measurement(NamedTuple):
    """Robot: the pose measured at `tick` [m, m, rad], the command then in force [m/s, rad/s]."""

    x: float
    y: float
    theta: float
    v: float
    omega: float
    tick: int
    command_tick: int


class Command(NamedTuple):
    """Station: the command for `tick` [m/s, rad/s]; so many estimates precede it."""

    v: float
    omega: float
    tick: int
    target_system: int
    target_component: int
    estimates: int


class Estimate(NamedTuple):
    """Station: the estimate at `tick` after its correction [m, m, rad], and its covariance."""

    x: float
    y: float
    theta: float
    p_xx: float
    p_xy: float
    p_xt: float
    p_yy: float
    p_yt: float
    p_tt: float
    tick: int


class End(NamedTuple):
    """Either side: the run ended after `tick` for this reason."""

    tick: int
    reason: int


WRITTEN_OUT: dict[str, type[Message]] = {
    "LAGLAB_TICK": Tick,
    "LAGLAB_MEASUREMENT": Measurement,
    "LAGLAB_COMMAND": Command,
    "LAGLAB_ESTIMATE": Estimate,
    "LAGLAB_END": End,
    **STANDARD,
}

_IDS: dict[str, int] = {made.msgname: number for number, made in dialect.mavlink_map.items()}
_types = dict(WRITTEN_OUT)


def message_id(name: str) -> int:
    """The id of the message with this name. Raises DialectError when the dialect has none."""
    if name not in _IDS:
        raise DialectError(f"no message {name!r} in the dialect: write it as the XML does")
    return _IDS[name]


def message_type(name: str) -> type[Message]:
    """The NamedTuple class of any message of the dialect, by its name in the XML."""
    if name not in _types:
        generated = dialect.mavlink_map[message_id(name)]
        _types[name] = namedtuple(name, generated.ordered_fieldnames)
    return _types[name]
