"""What a side in a process of its own is told, and what it says."""

from typing import Annotated

from msgspec import Meta, Struct

from laglab.runs.glance import Glance
from laglab_gateway import LinkReport, TimingReport
from laglab_station import StationReport


class Order(Struct, frozen=True):
    """Which side to be: all that a side needs to know."""

    scenario: str
    """As TOML."""
    url: str
    directory: str = ""
    """Where the robot's side keeps its record."""
    plant: str | None = None
    key: str | None = None
    plant_key: str | None = None
    live: str | None = None
    """How to call the live page, if there is one."""


class Listening(Struct, frozen=True, tag=True):
    """The side waits for the other one at this address."""

    address: str


class Progress(Struct, frozen=True, tag=True):
    """The side has finished this tick, `loop_seconds` [s] after the first."""

    tick: int
    loop_seconds: Annotated[float, Meta(ge=0)]
    glance: Glance | None = None


class Warned(Struct, frozen=True, tag=True):
    """What a person must not overlook."""

    text: str


class Finished(Struct, frozen=True, tag=True):
    """The robot's side is through: how the run ended, and what it says of it."""

    reason: int
    tick: int
    loop_seconds: float
    link: LinkReport
    timing: TimingReport | None


class CutShort(Struct, frozen=True, tag=True):
    """How far the robot's side came before it failed, as it says next."""

    loop_seconds: float
    link: LinkReport
    timing: TimingReport | None


class Answered(Struct, frozen=True, tag=True):
    """The station's side is through."""

    station: StationReport


class Failed(Struct, frozen=True, tag=True):
    """The side gave up, and why."""

    reason: str
    begun: bool
    """Whether the run had begun: what was wrong before is for the user to mend."""


class Computed(Struct, frozen=True, tag=True):
    """A job is done."""

    answer: bytes
    """Pickled."""


class Showing(Struct, frozen=True, tag=True):
    """The live page is there: at which port, and how the loop is to call it."""

    port: int
    line: str


class Ended(Struct, frozen=True, tag=True):
    """The process is gone, and how; always the last that is heard of it."""

    how: str


Report = (
    Listening
    | Progress
    | Warned
    | Finished
    | CutShort
    | Answered
    | Failed
    | Computed
    | Showing
    | Ended
)
