"""How the sides of a run ended."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from laglab_gateway import LinkReport, Outcome, TimingReport
from laglab_protocol import EndReason
from laglab_station import StationReport

EXIT_CODES = {
    EndReason.COMPLETED: 0,
    EndReason.DIVERGED: 3,
    EndReason.INTERRUPTED: 130,
    EndReason.FAILED: 4,
    EndReason.DISPLACED: 4,
}
KNOWN_BEFORE = 2
BROKE = 4
STOPPED = 5
"""An emergency stop: the run went on to its end without the robot."""


@dataclass(frozen=True)
class Ending:
    """An outcome, or the problem that cut the run short; and what each side told of it."""

    outcome: Outcome | None = None
    problem: str = ""
    begun: bool = True
    """Whether the run had begun; a problem before that is the user's to mend."""
    loop_seconds: float = 0.0
    link: LinkReport | None = None
    timing: TimingReport | None = None
    station: StationReport | None = None
    warnings: tuple[str, ...] = ()

    def warned(self, texts: Iterable[str]) -> "Ending":
        """With these warnings too: what both sides warn of stands there once."""
        return replace(self, warnings=tuple(dict.fromkeys((*self.warnings, *texts))))

    @property
    def emergency_stop(self) -> bool:
        """Whether somebody stopped the robot for good, as far as this side knows."""
        link, station = self.link, self.station
        heard = station is not None and station.emergency_tick is not None
        return heard or bool(link and link.emergency_stops)

    @property
    def exit_code(self) -> int:
        """Of the command that made the run."""
        if self.outcome:
            return EXIT_CODES[self.outcome.reason] or (STOPPED if self.emergency_stop else 0)
        return BROKE if self.begun else KNOWN_BEFORE
