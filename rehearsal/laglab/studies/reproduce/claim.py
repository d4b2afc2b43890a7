"""A claim of the paper, and what a run says to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

from msgspec import Struct

Numbers = Mapping[str, float]


class Evidence(Struct, frozen=True):
    """What an experiment found."""

    numbers: dict[str, float]
    picture: bytes = b""
    """PNG; empty without one."""


class Verdict(Enum):
    """Whether a claim is true."""

    HOLDS = "holds"
    LIMITED = "holds with"
    HARMLESS = "a misprint that does not show"
    FAILS = "does not hold"


def never(numbers: Numbers) -> bool:
    """A criterion that is never met."""
    del numbers
    return False


@dataclass(frozen=True)
class Claim:
    """One sentence, figure or equation of the paper."""

    name: str
    """In lower case with hyphens; also names the picture."""
    place: str
    """Where in the paper."""
    says: str
    """What it says, in our words."""
    command: str
    """A command that shows the same to whoever types it."""
    experiment: Callable[[], Evidence]
    got: str
    """What came out; a format of the experiment's numbers."""
    holds: Callable[[Numbers], bool]
    nearly: Callable[[Numbers], bool] = never
    """When it does not hold as it stands, and yet more is to be said than that."""
    then: Verdict = Verdict.LIMITED
    """The verdict in that case."""
    provided: str = ""
    """With what it holds, if it is limited."""
    why: str = ""
    """What else there is to say."""

    def verdict(self, numbers: Numbers) -> Verdict:
        """By the two criteria."""
        if self.holds(numbers):
            return Verdict.HOLDS
        return self.then if self.nearly(numbers) else Verdict.FAILS

    def spelled(self, verdict: Verdict) -> str:
        """The verdict, with the condition if there is one."""
        return f"holds with {self.provided}" if verdict is Verdict.LIMITED else verdict.value


class Finding(Struct, frozen=True):
    """A claim that has been tried."""

    name: str
    evidence: Evidence
