"""What stands around the robot's side while a loop serves it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic
from typing import NamedTuple

from laglab_gateway.loops.watch import Watch
from laglab_gateway.outcome import Outcome
from laglab_gateway.record.audit import LinkReport
from laglab_gateway.record.lateness import TimingReport
from laglab_gateway.record.recorder import Recorder
from laglab_gateway.side import RobotSide
from laglab_protocol import EndReason, Listener

READ_ON = 64
"""Looks at what waits to be read, before somebody counts as silent: it may be we who were held up,
and not all that waits tells that the other is there."""


def unheard(_: object) -> None:
    """For what nobody asked to be told."""


@dataclass(frozen=True)
class Patience:
    """How long to wait, all in wall seconds; `connect` None waits for the station for ever."""

    repeat_after: float = 0.1
    silence: float = 3.0
    connect: float | None = None

    @property
    def robot_silence(self) -> float:
        """Of a real robot: shorter, so that the station hears of it before it gives us up."""
        return self.silence / 3

    @property
    def in_force(self) -> float:
        """Heard so lately, a station keeps the robot: nobody at another address takes its place."""
        return self.silence / 3


@dataclass(frozen=True)
class Surroundings:
    """The station's end of the link, and everybody else that a loop tells of the run."""

    station: Listener
    recorder: Recorder = field(default_factory=Recorder)
    patience: Patience = Patience()
    watch: Watch | None = None
    progress: Callable[[int], None] = unheard
    """Told of each tick that is over."""
    warn: Callable[[str], None] = unheard
    """Told, in a line, of what a person must not overlook."""
    now: Callable[[], float] = monotonic


class Served(NamedTuple):
    """How a run went that is over."""

    outcome: Outcome
    link: LinkReport
    timing: TimingReport | None
    """Of ticks on the wall clock; None where ticks wait for the station."""


def served(side: RobotSide) -> Served:
    """How a run went; of one that was cut short, how far it went, as one that failed."""
    timesync, lateness = side.services.timesync, side.lateness
    return Served(
        side.stop(EndReason.FAILED),
        side.audit.report(timesync.report() if timesync else None),
        lateness.report() if lateness else None,
    )
