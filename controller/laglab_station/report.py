"""What a station has to say of its run."""

from msgspec import Struct


class Alarm(Struct, frozen=True):
    """The estimate was found to be wrong."""

    tick: int
    cause: str


class Calibrated(Struct, frozen=True):
    """What is known of one parameter of the robot: of a wheel, by how much further it leads."""

    name: str
    value: float
    deviation: float
    """Standard deviation."""


class StationReport(Struct, frozen=True):
    """How a station's run went."""

    n_seen: int
    """n [ticks], as the robot's echoes have it at the end."""
    m_seen: int | None
    """m [ticks] of the last measurement."""
    tick_p50_s: float | None = None
    """Within so long [s] half of the ticks were answered; None for a station without a clock."""
    tick_p99_s: float | None = None
    tick_longest_s: float | None = None
    warnings: tuple[str, ...] = ()
    alarms: tuple[Alarm, ...] = ()
    """The first ones; none where the estimator is not guarded."""
    alarms_raised: int = 0
    """All."""
    gated: int = 0
    """Measurements that were too wild to be used."""
    late: int = 0
    """Measurements that came too late for play-out, and were not used."""
    emergency_tick: int | None = None
    """The last tick that was answered before the robot said that somebody had stopped it for good;
    None if it never did."""
    calibration: tuple[Calibrated, ...] = ()
    """What the estimator has learned of the robot at the end; most learn nothing."""
