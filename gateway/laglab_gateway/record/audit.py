"""The delay audit: what the stamps say of the link, against what it was told to be."""

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from laglab_gateway.drive import Refusal
from laglab_gateway.link.fates import Kind


@dataclass
class DirectionAudit:
    """One direction: delays in ticks by how often, and frames by what became of them."""

    configured: int
    delays: Counter[int] = field(default_factory=Counter)
    fates: Counter[Kind] = field(default_factory=Counter)
    reordered: int = 0
    newest: int = -1

    def arrived(self, stamp: int, tick: int) -> None:
        """A message stamped `stamp` came out of the link at `tick`."""
        self.delays[tick - stamp] += 1
        self.reordered += stamp < self.newest
        self.newest = max(self.newest, stamp)

    def report(self) -> dict[str, Any]:
        """Delays in ticks (jitter: their standard deviation), counts of frames."""
        delays = np.array(list(self.delays.elements()))
        measured = (
            {
                "min": int(delays.min()),
                "mean": float(delays.mean()),
                "max": int(delays.max()),
                "jitter": float(delays.std()),
            }
            if len(delays)
            else None
        )
        lost = {kind.value: count for kind, count in self.fates.items() if kind != Kind.DELIVERED}
        return {
            "configured": self.configured,
            "measured": measured,
            "arrived": len(delays),
            "lost": lost,
            "reordered": self.reordered,
        }


@dataclass
class Audit:
    """Both directions, and what the robot refused or did by itself."""

    command: DirectionAudit
    measurement: DirectionAudit
    refused: Counter[Refusal] = field(default_factory=Counter)
    unanswered: int = 0
    """Ticks that were over before the station's answer to them had come."""
    stops: list[int] = field(default_factory=list)
    """Ticks at which the failsafe began to stop the robot."""

    def report(self) -> dict[str, Any]:
        """For the summary."""
        return {
            "command": self.command.report(),
            "measurement": self.measurement.report(),
            "refused": {refusal.value: count for refusal, count in self.refused.items()},
            "unanswered": self.unanswered,
            "failsafe_stops": self.stops,
        }
