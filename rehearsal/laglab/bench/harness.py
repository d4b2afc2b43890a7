"""Contenders take turns at the same work, round after round, so that a busy machine disturbs all
alike. It only ever adds to what they take: of each the fastest turn counts, as in timeit, and the
median tells how much was added.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from statistics import median
from time import perf_counter
from typing import NamedTuple

import laglab
from laglab.bench.result import SCHEMA, Figure, Report, Result, Timing, this_machine

Turn = Callable[[], float]
"""Does its work once; gives the seconds that a piece of it took."""
Progress = Callable[[str], None]


class Unit(NamedTuple):
    """What a turn's seconds are told in."""

    name: str
    seconds: float


MILLISECONDS = Unit("ms", 1e-3)


def microseconds(piece: str) -> Unit:
    """For a piece of work such as a tick or a message."""
    return Unit(f"µs a {piece}", 1e-6)


@dataclass(frozen=True)
class Contest:
    """Contenders by name, in one or several cases, each of which has the yardstick among them."""

    title: str
    unit: Unit
    yardstick: str
    cases: Mapping[str, Mapping[str, Turn]]


Figures = Callable[[Sequence[Result], Progress], Sequence[Figure]]


def no_figures(_: Sequence[Result], __: Progress) -> Sequence[Figure]:
    """For a bench whose ratios say all."""
    return ()


@dataclass(frozen=True)
class Bench:
    """What one command measures, and what it tells besides: drawn from the results, or found out
    when they are there."""

    name: str
    contests: Sequence[Contest]
    figures: Figures = no_figures


def timed(work: Callable[[], object], pieces: int) -> Turn:
    """The turn of a contender whose `work` does that many `pieces` in one go."""

    def turn() -> float:
        began = perf_counter()
        work()
        return (perf_counter() - began) / pieces

    return turn


def run(bench: Bench, rounds: int, progress: Progress) -> Report:
    """All that the bench measures, one contest after the other."""
    began, machine = datetime.now(UTC), this_machine()
    results = tuple(measure(contest, rounds, progress) for contest in bench.contests)
    figures = tuple(bench.figures(results, progress))
    version = laglab.__version__
    return Report(SCHEMA, bench.name, version, began, machine, rounds, results, figures)


def measure(contest: Contest, rounds: int, progress: Progress) -> Result:
    """Every contender of every case takes its turn once a round."""
    taken = {(case, name): list[float]() for case, turns in contest.cases.items() for name in turns}
    for number in range(1, rounds + 1):
        for (case, name), seconds in taken.items():
            progress(f"{contest.title}, round {number} of {rounds}: {case} {name}")
            seconds.append(contest.cases[case][name]())
    timings = [
        _timing(case, name, seconds, taken[case, contest.yardstick], contest.unit)
        for (case, name), seconds in taken.items()
    ]
    return Result(contest.title, contest.yardstick, tuple(timings))


def _timing(
    case: str, name: str, seconds: Sequence[float], yardstick: Sequence[float], unit: Unit
) -> Timing:
    fastest = min(seconds)
    return Timing(
        case=case,
        name=name,
        fastest=fastest / unit.seconds,
        median=median(seconds) / unit.seconds,
        unit=unit.name,
        ratio=fastest / min(yardstick),
    )
