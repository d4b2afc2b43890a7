"""What a station has to say of its run."""

from msgspec import Struct

from laglab_protocol import Quantiles


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

    @classmethod
    def of(
        cls, n_seen: int, m_seen: int | None, times: Quantiles | None, warnings: tuple[str, ...]
    ) -> "StationReport":
        """With the times of the ticks, if they were taken."""
        p50, p99, longest = times or (None, None, None)
        return cls(n_seen, m_seen, p50, p99, longest, warnings)
