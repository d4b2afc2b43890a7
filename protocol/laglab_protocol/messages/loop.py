"""The messages of our own dialect: the loop's, and those that measure its link; in wire order."""

import math
from enum import IntEnum

from laglab_protocol.messages.base import Message

NO_COMMAND = -1
"""Measurement.command_tick when no command had come into force."""

UNANNOUNCED = 256
"""More frames than LAGLAB_TICK or LAGLAB_COMMAND can announce: no more need be kept."""

DIALECT_VERSION = 3
"""As the dialect's XML has it."""

UNKNOWN_DELAY = 65535

RECALLED = 12
"""Ticks that one LAGLAB_APPLIED tells of."""

PLANNED = 15
"""Ticks that one LAGLAB_PLAN plans for."""
LONGEST_PLAN = 240
"""Ticks: sixteen frames, that one LAGLAB_COMMAND can announce and one datagram carry."""

NO_PROBE = 4294967295
"""In Probe.came, where no arrival is told of."""

PROBE_LAGS = (0, 16, 240)
"""By place in Probe.came: an arrival is told so many arrivals later."""

PROBE_FILLER = 180
"""Bytes that a probe may be longer than its other fields."""

ROBOT = ROBOT_SYSTEM, ROBOT_COMPONENT = 1, 1
STATION = STATION_SYSTEM, STATION_COMPONENT = 200, 190


class EndReason(IntEnum):
    """Why a run ended (LAGLAB_END_REASON)."""

    COMPLETED = 0
    DIVERGED = 1
    INTERRUPTED = 2
    FAILED = 3
    DISPLACED = 4


class Tick(Message, frozen=True):
    """Robot: tick k has begun; so many measurements precede this message in its datagram."""

    tick: int
    measurements: int


class Measurement(Message, frozen=True):
    """Robot: the pose measured at `tick` [m, m, rad], and the command in force until then
    [m/s, rad/s]."""

    x: float
    y: float
    theta: float
    v: float
    omega: float
    tick: int
    command_tick: int

    @property
    def pose(self) -> tuple[float, float, float]:
        """x, y [m] and θ [rad], as measured."""
        return self.x, self.y, self.theta

    @property
    def speeds(self) -> tuple[float, float]:
        """v [m/s] and ω [rad/s], as commanded."""
        return self.v, self.omega


class Command(Message, frozen=True):
    """Station: the command for `tick` [m/s, rad/s]; so many estimates and recalls precede
    it, and it plans for so many ticks more."""

    v: float
    omega: float
    tick: int
    target_system: int
    target_component: int
    estimates: int
    plan: int = 0

    @property
    def speeds(self) -> tuple[float, float]:
        """v [m/s] and ω [rad/s]."""
        return self.v, self.omega


class Estimate(Message, frozen=True):
    """Station: the estimate at `tick` after its correction [m, m, rad], and its covariance [m²,
    m rad, rad²], the upper triangle."""

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

    @property
    def pose(self) -> tuple[float, float, float]:
        """x, y [m] and θ [rad]."""
        return self.x, self.y, self.theta


class End(Message, frozen=True):
    """Either side: the run ended after `tick` for this reason."""

    tick: int
    reason: int


class Settings(Message, frozen=True):
    """Either side: what it was told of the run [s, m, m/s, rad/s, ticks]; NaN and 65535: not known,
    an infinite limit: none. A play-out or plan of 0: none."""

    sample_time: float
    wheel_radius: float = math.nan
    track: float = math.nan
    v_max: float = math.nan
    omega_max: float = math.nan
    command_delay: int = UNKNOWN_DELAY
    measurement_delay: int = UNKNOWN_DELAY
    dialect: int = DIALECT_VERSION
    command_playout: int = 0
    measurement_playout: int = 0
    plan: int = 0


class Recall(Message, frozen=True):
    """Station: which speeds were in force at `count` ticks from `first` on?"""

    first: int
    count: int
    target_system: int
    target_component: int


class Applied(Message, frozen=True):
    """Robot: the speeds in force on [t_j, t_{j+1}) [m/s, rad/s], j = first ... first + count - 1;
    NaN: not known any more."""

    v: tuple[float, ...]
    omega: tuple[float, ...]
    first: int
    count: int


class Plan(Message, frozen=True):
    """Station: the speeds [m/s, rad/s] that are to follow the command of `tick`, which is meant for
    the tick `in_force`: element i here is for in_force + first + i."""

    v: tuple[float, ...]
    omega: tuple[float, ...]
    tick: int
    in_force: int
    first: int
    target_system: int
    target_component: int


class Probe(Message, frozen=True):
    """Either side, to measure the link: its clock [ns], and when which of the other's came."""

    time_ns: int
    came_ns: tuple[int, ...]
    session: int
    sequence: int
    interval_us: int
    came: tuple[int, ...]
    filler: tuple[int, ...]
