"""How fast the loop is, against a bare echo of its bytes and against the same loop by hand."""

import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import get_args

from laglab.bench.by_hand import Link, seconds_per_echo, tick_sizes
from laglab.bench.by_hand import loop as by_hand
from laglab.bench.harness import Bench, Contest, Progress, Turn, Unit, microseconds
from laglab.bench.result import Figure, Result
from laglab.bench.whole_run import (
    SAMPLE_TIME,
    lateness,
    loop_of,
    loop_scenario,
    seconds_per_run,
    seconds_per_tick,
)
from laglab.runs.rehearse import Transport

TICK = microseconds("tick")
LINKS: tuple[Link, ...] = get_args(Link)
ESTIMATORS = ("popf", "raw")
PROCESSES: tuple[Transport, ...] = ("inline", "udp")
ECHO, BY_HAND, OURS = "bare echo", "by hand", "laglab"


def bench(ticks: int, realtime: float, links: Sequence[Link] = LINKS) -> Bench:
    """Runs of `ticks` ticks, with a filter in the loop and with none; at the end, one that keeps to
    the clock for `realtime` seconds."""
    cases = {f"{link}, {name}": _ways(link, name, ticks) for link in links for name in ESTIMATORS}
    n, m, *_ = loop_of(loop_scenario(ESTIMATORS[0], ticks))
    contest = Contest(f"the loop, n = {n}, m = {m}", TICK, OURS, cases)

    def figures(results: Sequence[Result], progress: Progress) -> list[Figure]:
        progress("real time")
        return [*_speeds(results[0], list(cases)), *_lateness(realtime)]

    return Bench("loop", [contest, *_one_or_two(ticks)], figures)


def _one_or_two(ticks: int) -> Iterator[Contest]:
    """In one process the two sides take turns; two work side by side, but have to be started."""
    scenarios = {name: loop_scenario(name, ticks) for name in ESTIMATORS}
    running: dict[str, dict[str, Turn]] = {
        name: {each: _in_a_folder(partial(seconds_per_tick, each, scenario)) for each in PROCESSES}
        for name, scenario in scenarios.items()
    }
    whole: dict[str, dict[str, Turn]] = {
        name: {each: partial(seconds_per_run, each, name) for each in PROCESSES}
        for name in ("fig6", "lab")
    }
    yield Contest("one process or two, once they run", TICK, "udp", running)
    if hasattr(os, "sched_setaffinity"):
        alone = {
            name: {each: _on_one_processor(turn) for each, turn in turns.items()}
            for name, turns in running.items()
        }
        yield Contest("the same on one processor", TICK, "udp", alone)
    yield Contest("one process or two, from call to result", Unit("s", 1.0), "udp", whole)


def _ways(link: Link, estimator: str, ticks: int) -> dict[str, Turn]:
    scenario = loop_scenario(estimator, ticks)
    sizes = tick_sizes(estimates=estimator != "raw")
    return {
        ECHO: lambda: seconds_per_echo(link, sizes, ticks),
        BY_HAND: _in_a_folder(lambda folder: by_hand.seconds_per_tick(link, scenario, folder)),
        OURS: _in_a_folder(lambda folder: seconds_per_tick(link, scenario, folder)),
    }


def _in_a_folder(turn: Callable[[Path], float]) -> Turn:
    """An empty one, which is gone afterwards."""

    def in_folder() -> float:
        with tempfile.TemporaryDirectory(prefix="laglab-bench-") as folder:
            return turn(Path(folder))

    return in_folder


def _on_one_processor(turn: Turn) -> Turn:
    """Of all that there are, for this process and those that it starts."""

    def on_one() -> float:
        with _bound_to(min(os.sched_getaffinity(0))):
            return turn()

    return on_one


@contextmanager
def _bound_to(processor: int) -> Iterator[None]:
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {processor})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def _speeds(result: Result, cases: Sequence[str]) -> Iterator[Figure]:
    """The loop's against the clock and against the link alone."""
    for case in cases:
        ours = result.fastest(case, OURS) * TICK.seconds
        yield Figure(f"{case}: {OURS}", SAMPLE_TIME / ours, "× real time")
    for case in cases:
        echoes = result.fastest(case, OURS) / result.fastest(case, ECHO)
        yield Figure(f"{case}: {OURS}", echoes, "bare echoes")


def _lateness(seconds: float) -> Iterator[Figure]:
    with tempfile.TemporaryDirectory(prefix="laglab-bench-") as folder:
        late = lateness(seconds, Path(folder))
    for name, value in (("p50", late.p50_s), ("p99", late.p99_s), ("max", late.max_s)):
        yield Figure(f"real time, late by: {name}", 1e3 * value, "ms")
    yield Figure("real time: deadlines missed", late.missed_deadlines, "")
