"""The delay audit: what the stamps say of the link, against what it was told to be."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from msgspec import Struct

from laglab_gateway.drive import Rejection
from laglab_gateway.link.fates import FateKind

STOPS_KEPT = 100
"""Ticks of stops that are kept, the first ones; all stops are counted."""


class DelayReport(Struct, frozen=True):
    """Delays [ticks]; jitter is their standard deviation."""

    min: int
    mean: float
    max: int
    jitter: float


class DirectionReport(Struct, frozen=True):
    """One direction: the delay as configured and as measured [ticks], frames by what became of
    them."""

    configured: int
    measured: DelayReport | None
    arrived: int
    lost: dict[str, int]
    reordered: int


class ClockReport(Struct, frozen=True):
    """What TIMESYNC found: the station's clock less ours, and the way there and back [s]."""

    offset_s: float
    round_trip_p50_s: float
    round_trip_p99_s: float
    samples: int


class LinkReport(Struct, frozen=True):
    """Both directions, and what the robot refused or did by itself."""

    command: DirectionReport
    measurement: DirectionReport
    refused: dict[str, int]
    unanswered: int
    """Ticks that were over before the station's answer to them had come."""
    failsafe_stops: list[int]
    """Ticks at which the failsafe began to stop the robot; of many, the first."""
    stops: int
    """How many failsafe stops there were."""
    timesync: ClockReport | None = None
    emergency_stops: int = 0
    emergency_ticks: list[int] = []
    """Ticks at which somebody asked for an emergency stop; of many, the first."""


@dataclass
class DirectionAudit:
    """One direction: delays in ticks by how often, and frames by what became of them."""

    configured: int
    delays: Counter[int] = field(default_factory=Counter)
    fates: Counter[FateKind] = field(default_factory=Counter)
    reordered: int = 0
    newest: int = -1

    def arrived(self, stamp: int, tick: int) -> None:
        """A message stamped `stamp` came out of the link at `tick`."""
        self.delays[tick - stamp] += 1
        self.reordered += stamp < self.newest
        self.newest = max(self.newest, stamp)

    def begin_anew(self) -> None:
        """The stamps begin again."""
        self.newest = -1

    def report(self) -> DirectionReport:
        """As it is now."""
        lost = {kind.value: n for kind, n in self.fates.items() if kind != FateKind.DELIVERED}
        arrived = self.delays.total()
        return DirectionReport(self.configured, self._measured(), arrived, lost, self.reordered)

    def _measured(self) -> DelayReport | None:
        if not self.delays:
            return None
        delays, counts = np.array(list(self.delays.items()), dtype=np.float64).T
        mean = float(np.average(delays, weights=counts))
        jitter = float(np.sqrt(np.average((delays - mean) ** 2, weights=counts)))
        return DelayReport(min(self.delays), mean, max(self.delays), jitter)


@dataclass
class Audit:
    """Both directions, and what the robot refused or did by itself."""

    command: DirectionAudit
    measurement: DirectionAudit
    refused: Counter[Rejection] = field(default_factory=Counter)
    unanswered: int = 0
    stops: int = 0
    first_stops: list[int] = field(default_factory=list)
    emergency_stops: int = 0
    first_emergencies: list[int] = field(default_factory=list)

    def stopped(self, tick: int) -> None:
        """The failsafe began to stop the robot at `tick`."""
        self.stops += 1
        if len(self.first_stops) < STOPS_KEPT:
            self.first_stops.append(tick)

    def emergency_stopped(self, stops: int, tick: int) -> bool:
        """There were so many emergency stops by the end of `tick`; True when that is news."""
        news = stops > self.emergency_stops
        self.emergency_stops = stops
        if news and len(self.first_emergencies) < STOPS_KEPT:
            self.first_emergencies.append(tick)
        return news

    def of(self, direction: str) -> DirectionAudit:
        """One of the two."""
        return self.command if direction == "command" else self.measurement

    def report(self, clocks: ClockReport | None = None) -> LinkReport:
        """As it is now."""
        return LinkReport(
            command=self.command.report(),
            measurement=self.measurement.report(),
            refused={rejection.value: count for rejection, count in self.refused.items()},
            unanswered=self.unanswered,
            failsafe_stops=list(self.first_stops),
            stops=self.stops,
            timesync=clocks,
            emergency_stops=self.emergency_stops,
            emergency_ticks=list(self.first_emergencies),
        )
