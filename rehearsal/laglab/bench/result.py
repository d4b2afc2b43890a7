"""What a benchmark found, typed, and written as JSON for other programs."""

import os
import platform
from dataclasses import dataclass
from datetime import datetime

SCHEMA = 1
"""The version of the JSON: another one when a field means something else."""


@dataclass(frozen=True)
class Timing:
    """What one contender took in one case."""

    case: str
    name: str
    fastest: float
    """Of its turns, in `unit`."""
    median: float
    unit: str
    ratio: float
    """Of its fastest to the yardstick's."""


@dataclass(frozen=True)
class Result:
    """A contest's timings, case by case."""

    title: str
    yardstick: str
    timings: tuple[Timing, ...]

    def fastest(self, case: str, name: str) -> float:
        """The contender's, in `unit`. Raises KeyError when it was not in that case."""
        return {(each.case, each.name): each.fastest for each in self.timings}[case, name]


@dataclass(frozen=True)
class Figure:
    """A number that stands by itself."""

    name: str
    value: float
    unit: str


@dataclass(frozen=True)
class Machine:
    """The machine on which it was measured, and how busy that was before."""

    cpus: int
    python: str
    platform: str
    load: float | None
    """Processes that ran or wanted to, over the last minute; None where nobody counts them."""


def this_machine() -> Machine:
    """As it is now."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return Machine(os.cpu_count() or 1, platform.python_version(), platform.platform(), load)


@dataclass(frozen=True)
class Report:
    """All of a benchmark."""

    schema: int
    bench: str
    laglab: str
    """Its version."""
    began: datetime
    machine: Machine
    rounds: int
    results: tuple[Result, ...]
    figures: tuple[Figure, ...]
