"""How fast the loop is, against a bare echo of its bytes and against the same loop by hand.

Of each way the fastest round counts, as in timeit: what else the machine does only adds to it.
The median tells how much that was.
"""

import tempfile
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from rich.table import Table

from laglab.bench import by_hand
from laglab.bench.round_trip import seconds_per_echo, tick_sizes
from laglab.errors import RunError
from laglab.run.rehearse import Transport, rehearse
from laglab.scenario import Scenario, load

TRANSPORTS: tuple[Transport, ...] = ("udp", "serial")
ESTIMATORS = ("popf", "raw")
SAMPLE_TIME = 0.01
WAYS = ("bare echo", "by hand", "laglab")

Case = tuple[Transport, str]
"""Transport and estimator."""
Progress = Callable[[str], None]


class Times(NamedTuple):
    """Seconds a tick takes each way, in one round or over all."""

    bare_echo: float
    by_hand: float
    laglab: float


def loop_scenario(estimator: str, ticks: int) -> Scenario:
    """n = 10 and m = 20, noise on; an estimator in the loop or none, within the same limits."""
    return load(
        "lab",
        {
            "estimator.kind": estimator,
            "duration": ticks * SAMPLE_TIME,
            "sample_time": SAMPLE_TIME,
            "estimator.initial_covariance": 1e-4,
            "estimator.initial_estimate": "start",
        },
    )


def measure(
    rounds: int, ticks: int, progress: Progress, transports: Sequence[Transport] = TRANSPORTS
) -> dict[Case, list[Times]]:
    """Times by round, in each of which every way is measured once, one after another."""
    cases = [(transport, estimator) for transport in transports for estimator in ESTIMATORS]
    taken: dict[Case, list[Times]] = {case: [] for case in cases}
    for number in range(1, rounds + 1):
        for transport, estimator in cases:
            progress(f"round {number} of {rounds}: {transport}, {estimator}")
            taken[transport, estimator].append(_one_round(transport, estimator, ticks))
    return taken


def _over(rounds: Iterable[Times], of_way: Callable[[Iterable[float]], float]) -> Times:
    return Times(*map(of_way, zip(*rounds, strict=True)))


def _one_round(transport: Transport, estimator: str, ticks: int) -> Times:
    scenario = loop_scenario(estimator, ticks)
    with tempfile.TemporaryDirectory(prefix="laglab-bench-") as folder:
        return Times(
            seconds_per_echo(transport, tick_sizes(estimates=estimator != "raw"), ticks),
            by_hand.seconds_per_tick(transport, scenario, Path(folder)),
            _seconds_per_tick(transport, scenario, Path(folder)),
        )


def _seconds_per_tick(transport: Transport, scenario: Scenario, directory: Path) -> float:
    """As `laglab run` runs it, from its first tick to its last."""
    ending = rehearse(scenario, transport, directory, lambda _: None)
    if ending.outcome is None:
        raise RunError(f"the loop over {transport} ended early: {ending.problem}")
    return ending.loop_seconds / scenario.must_end()


def measure_lateness(seconds: float) -> dict[str, Any]:
    """Of the ticks of `laglab run lab --pace realtime` over UDP, in the summary's terms."""
    scenario = load("lab", {"pace": "realtime", "duration": seconds})
    with tempfile.TemporaryDirectory(prefix="laglab-bench-") as folder:
        ending = rehearse(scenario, "udp", Path(folder), lambda _: None)
    if ending.outcome is None:
        raise RunError(f"the real-time loop ended early: {ending.problem}")
    timing: dict[str, Any] = ending.statistics["timing"]
    return timing


COLUMNS = (*WAYS, "× real time", "× by hand", "echoes")


def times_table(measured: dict[Case, list[Times]]) -> Table:
    """A row each for transport and estimator: µs a tick each way, and ours in ratios."""
    title = "µs a tick in the fastest round (in the median one), n = 10, m = 20"
    table = Table("link", "estimator", box=None, title=title)
    for heading in COLUMNS:
        table.add_column(heading, justify="right", no_wrap=True)
    for (transport, estimator), rounds in measured.items():
        times, usual = _over(rounds, min), _over(rounds, median)
        microseconds = [
            f"{1e6 * fastest:.0f} ({1e6 * middle:.0f})"
            for fastest, middle in zip(times, usual, strict=True)
        ]
        ratios = (
            f"{SAMPLE_TIME / times.laglab:.0f}",
            f"{times.by_hand / times.laglab:.2f}",
            f"{times.laglab / times.bare_echo:.1f}",
        )
        table.add_row(transport, estimator, *microseconds, *ratios)
    return table


def lateness_line(timing: dict[str, Any]) -> str:
    """How late the ticks of a real-time run began."""
    p50, p99, most = (1e3 * timing[key] for key in ("p50_s", "p99_s", "max_s"))
    return (
        f"real time, late by: p50 {p50:.3f} ms, p99 {p99:.3f} ms, max {most:.3f} ms; "
        f"deadlines missed: {timing['missed_deadlines']}"
    )
