"""What became of a turn: the facts, which the expectations judge."""

from dataclasses import dataclass
from typing import NamedTuple

from laglab.soak.turn import Side, Signal, Turn


class Sample(NamedTuple):
    """A side, looked at while its run was under way."""

    memory: int
    """[bytes] Its own, without libraries."""
    descriptors: int


@dataclass(frozen=True)
class Part:
    """One process of a side, from its start to its end."""

    side: Side
    exit_code: int
    said: str
    """On standard output and error."""
    met: bool
    """Whether it has met the other side, before a signal came."""
    samples: tuple[Sample, ...]
    most_memory: int
    """[bytes] Ever, libraries and its figure included."""
    signal: Signal | None = None
    """What it was sent by the blow."""
    dismissed: bool = False
    """Whether it was sent home, since it did not end by itself."""
    verdict: str = ""
    faults: tuple[str, ...] = ()
    """Of its files: what is missing, torn or cannot be read."""
    left: tuple[str, ...] = ()
    """Temporary files and what else does not belong there."""
    ticks: int = 0


@dataclass(frozen=True)
class Played:
    """A turn that is over."""

    turn: Turn
    parts: tuple[Part, ...]
    trace_fault: str | None = None
    """In what `trace.csv` is not the one inline, nothing if it is; None: that was not asked."""
    left: tuple[str, ...] = ()
    """Links of ports in the turn's folder."""
    running: tuple[int, ...] = ()
    """Processes that go on running."""
    descriptors: tuple[int, int] = (0, 0)
    """Our own, before and after."""
    datagrams: int = 0
    """That strangers sent."""

    @property
    def struck(self) -> Part | None:
        """The part that the blow has ended, if it came in time."""
        ended = (part for part in self.parts if part.signal not in (None, "SIGSTOP"))
        return next(ended, None)
