"""One situation of a soak: what runs, over what, and what happens to it meanwhile."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from laglab.scenario import Scenario, load
from laglab.scenario.overrides import Overrides

Side = Literal["gateway", "controller"]
Transport = Literal["udp", "serial"]
Signal = Literal["SIGKILL", "SIGTERM", "SIGINT", "SIGSTOP"]
Strangers = Literal["garbage", "foreign frames", "requests", "bad signatures", "an impostor"]

PATIENCE = 10.0
"""[s] The silence that a side forgives: the machine may be busy with other things."""
SHORT_PATIENCE = 2.0
"""[s] The same where a side is ended and has to be missed."""
LONG_PATIENCE = 30.0
"""[s] The same where a side is started again, which takes as long as Python and its modules."""


@dataclass(frozen=True)
class Blow:
    """A signal to one of the sides; after a SIGSTOP it goes on again soon."""

    side: Side
    signal: Signal
    after: float
    """[s] since the first tick; of one that comes `early`, since the controller was started."""
    early: bool = False
    """Whether it comes while the two have perhaps not met."""
    again: bool = False
    """Whether the side is started again, and the run goes on."""


@dataclass(frozen=True)
class Turn:
    """A situation, whole: the same again is the same turn."""

    number: int
    base: str
    """The shipped scenario, and what is other than there."""
    overrides: Overrides
    transport: Transport
    signed: bool
    blow: Blow | None = None
    strangers: tuple[Strangers, ...] = ()
    rate: float = 0.0
    """Datagrams a second that strangers send, all together."""

    def scenario(self) -> Scenario:
        """What both sides run. Raises ScenarioError."""
        return load(self.base, {**self.overrides, "silence_timeout": self.patience})

    @property
    def goes_on(self) -> bool:
        """Whether no signal ends it."""
        return self.blow is None or self.blow.signal == "SIGSTOP"

    @property
    def patience(self) -> float:
        """[s] The silence that the sides forgive."""
        if self.goes_on or self.blow is None:
            return PATIENCE
        return LONG_PATIENCE if self.blow.again else SHORT_PATIENCE

    @property
    def lockstep(self) -> bool:
        """Whether every tick waits for its answer; then the ticks do not depend on the machine."""
        return self.overrides["pace"] == "lockstep"

    @property
    def kinds(self) -> Iterator[str]:
        """What it is counted under."""
        yield self.base
        yield "lock-step" if self.lockstep else "real time"
        yield self.transport
        yield "signed" if self.signed else "not signed"
        if "link.plan" in self.overrides:
            yield "plans"
        if any(key.startswith("link.playout.") for key in self.overrides):
            yield "play-out"
        yield from (f"strangers: {who}" for who in self.strangers)
        yield _told(self.blow) if self.blow else "no signal"


def _told(blow: Blow) -> str:
    when = " before they meet" if blow.early else ""
    return f"{blow.signal} to the {blow.side}{when}{', started again' if blow.again else ''}"
