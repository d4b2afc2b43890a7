"""What a tick of a robot costs in a study: many at once, one by one, and in other hands."""

from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from typing import NamedTuple

import numpy as np

from laglab.bench.by_hand import Situation, many_by_hand
from laglab.bench.fmu import PLAIN, plain_loop
from laglab.bench.harness import Bench, Contest, Progress, Turn, microseconds, timed
from laglab.bench.result import Figure, Result
from laglab.interface import run
from laglab.runs.station_side import station_config
from laglab.scenario import Scenario, load
from laglab.studies.many import run_many
from laglab.studies.workers import Processes

AT_ONCE, ALONE, BY_HAND = "at once", "one by one", "numpy by hand"
GUARDED = "at once, guarded"
KINDS = ("delayed-ekf", "popf")
FEW = 2
"""Robots that a turn runs one by one."""
SHARES = 4
"""Into how many a turn is cut that processes share."""
DELAYS = ((10, 20), (100, 20), (10, 200))
"""n and m: the first is the paper's, the others tell how the cost grows."""


def bench(robots: int, ticks: int, stack: ExitStack) -> Bench:
    """`lab` with each filter in its loop, from starts of their own, FMU steps included.

    Raises:
        FmuError: an FMU is not there, or there is no compiler for the plain C loop.
    """
    plain = plain_loop(robots, max(1, 20_000 // robots), stack)
    cases = {
        f"{kind} {n}/{m}": _ways(kind, (n, m), robots, ticks) | {PLAIN: plain}
        for kind in KINDS
        for n, m in DELAYS
    }
    contest = Contest("a robot's tick in a study", microseconds("robot-tick"), PLAIN, cases)
    shared = {"": {str(each): _shared_out(each, robots, ticks, stack) for each in (1, 2)}}
    by_two = Contest("the same, by so many processes", microseconds("robot-tick"), "1", shared)
    return Bench("study", [contest, by_two], _figures)


def _ways(kind: str, delays: tuple[int, int], robots: int, ticks: int) -> dict[str, Turn]:
    scenarios = _scenarios(kind, delays, robots, ticks)
    ways = {AT_ONCE: timed(partial(_at_once, scenarios), robots * ticks)}
    if delays != DELAYS[0]:
        return ways
    guarded = [each.overridden({"estimator.guard": True}) for each in scenarios]
    ways[GUARDED] = timed(partial(_at_once, guarded), robots * ticks)
    ways[ALONE] = timed(partial(_one_by_one, scenarios[:FEW]), FEW * ticks)
    if kind == "delayed-ekf":
        ways[BY_HAND] = timed(partial(_by_hand, scenarios, ticks), robots * ticks)
    return ways


def _scenarios(kind: str, delays: tuple[int, int], robots: int, ticks: int) -> list[Scenario]:
    n, m = delays
    overrides = {
        "estimator.kind": kind,
        "estimator.guard": False,
        "estimator.initial_covariance": 1e-4,
        "link.command_delay": n,
        "link.measurement_delay": m,
    }
    lab = load("lab", overrides)
    duration = (ticks - 1) * lab.sample_time
    return [
        lab.model_copy(update={"seed": seed, "duration": duration}) for seed in range(1, robots + 1)
    ]


class Share(NamedTuple):
    """What one process is to do."""

    robots: int
    ticks: int


def _shared_out(processes: int, robots: int, ticks: int, stack: ExitStack) -> Turn:
    workers = stack.enter_context(Processes(processes))
    shares = [Share(max(1, robots // SHARES), ticks)] * SHARES

    def work() -> None:
        for future in [workers.submit(at_once, share) for share in shares]:
            future.result()

    work()  # so that every process is there, and has loaded what it needs
    return timed(work, SHARES * shares[0].robots * ticks)


def at_once(share: Share) -> None:
    """One share, in a process of its own."""
    _at_once(_scenarios(KINDS[0], DELAYS[0], *share))


def _at_once(scenarios: Sequence[Scenario]) -> None:
    run_many(scenarios, lambda _: None)


def _one_by_one(scenarios: Sequence[Scenario]) -> None:
    for scenario in scenarios:
        run(scenario)


def _by_hand(scenarios: Sequence[Scenario], ticks: int) -> None:
    config, link = station_config(scenarios[0]), scenarios[0].link
    starts = np.array([each.first_estimate() for each in scenarios])
    situation = Situation(config, link.command_delay, link.measurement_delay, ticks)
    many_by_hand(starts, scenarios[0].estimator.initial_covariance, situation)


def _figures(results: Sequence[Result], _: Progress) -> list[Figure]:
    result, by_two = results
    figures = [
        Figure("two processes to one", by_two.fastest("", "1") / by_two.fastest("", "2"), "×")
    ]
    for kind in KINDS:
        paper, *others = (f"{kind} {n}/{m}" for n, m in DELAYS)
        ours = result.fastest(paper, AT_ONCE)
        alone = result.fastest(paper, ALONE)
        figures.append(Figure(f"{kind}: {ALONE} to {AT_ONCE}", alone / ours, "×"))
        for other in others:
            growth = result.fastest(other, AT_ONCE) / ours
            figures.append(Figure(f"{other} to {paper}", growth, "×"))
    return figures
