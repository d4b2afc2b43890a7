"""The ways to live with a link, beside each other on the same links."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from msgspec import Struct

from laglab.interface import run
from laglab.link.fitting import bound_for
from laglab.link.measured import Flow
from laglab.results.numbers import robot_pose
from laglab.runs.robot_side import link_fates
from laglab.scenario import Overrides, Scenario, both_ways, changed
from laglab.studies.judged import judged_run
from laglab.studies.workers import shared_out
from laglab_gateway import DIRECTIONS, FateKind, Fates

PLAN = 45
"""[ticks] How far the plans reach: their frames still fit into one datagram."""
LATE = 0.01
"""The share of the frames that may come after the bound of the play-out."""
MOST_TRIED = 5000
"""Frames by which the bounds are found."""
A_FRAME = bytes(64)

OWN_LINK = "its own"
"""The scenario's, where it is not ideal."""
NOTHING: Overrides = {
    "link.command": {},
    "link.measurement": {},
    "link.event": [],
    "link.replay": None,
}


def _random_delay(spread: float) -> object:
    return {"distribution": "uniform", "mean": spread / 2, "spread": spread / 2}


LINKS: Mapping[str, Overrides] = {
    "ideal": NOTHING,
    "jitter": {**NOTHING, **both_ways(extra_delay={"distribution": "exponential", "mean": 0.05})},
    "loss": {**NOTHING, **both_ways(loss=0.3)},
    "bursts": {**NOTHING, **both_ways(burst={"good_to_bad": 0.02, "bad_to_good": 0.05})},
    "outages": {**NOTHING, **both_ways(outages=[[2.0, 1.0], [6.0, 1.0]])},
    "random": {**NOTHING, **both_ways(extra_delay=_random_delay(0.1), loss=0.1)},
}
"""`random` is what the paper's authors went on to in 2014: random delays, by which frames overtake
each other, and losses."""


class Strategy(NamedTuple):
    """A way to live with a link."""

    keys: Overrides
    played_out: bool = False


def _station(estimator: str, guard: bool = False) -> Overrides:
    return {"estimator.kind": estimator, "estimator.guard": guard}


DEFAULT = _station("delayed-ekf", guard=True)
"""Of `lab`."""
STRATEGIES: Mapping[str, Strategy] = {
    "raw": Strategy(_station("raw")),
    "popf": Strategy({**_station("popf"), "estimator.initial_covariance": 1e-4}),
    "tue-predictor": Strategy(_station("tue-predictor")),
    "delayed-ekf": Strategy(_station("delayed-ekf")),
    "guarded": Strategy(DEFAULT),
    "play-out": Strategy(DEFAULT, played_out=True),
    "plans": Strategy({**DEFAULT, "link.plan": PLAN}),
}
"""`popf` has the P_0 of the paper: with that of `lab` it diverges."""


class Trial(Struct, frozen=True):
    """One run."""

    link: str
    strategy: str
    scenario: str
    """As TOML."""


class Fared(Struct, frozen=True):
    """What became of it."""

    link: str
    strategy: str
    converged: bool
    settled: float | None
    """[s] From when on the robot was at the goal; None: it was not, at the end."""
    rms: float | None
    """[m] Of the estimated position, over the ticks >= m; None: nothing was estimated."""
    driven: float
    """[m] The way that the robot went."""


def links_of(scenario: Scenario) -> dict[str, Overrides]:
    """On which they meet: LINKS, and the scenario's own where that is not ideal."""
    own: dict[str, Overrides] = {OWN_LINK: {}} if link_fates(scenario) else {}
    return {**LINKS, **own}


def trials(
    scenario: Scenario, links: Sequence[str], strategies: Sequence[str], seeds: int
) -> list[Trial]:
    """Every strategy on every link, seed after seed. Raises ScenarioError."""
    conditions = links_of(scenario)
    return [
        Trial(link, strategy, _met(scenario, conditions[link], strategy, number).to_toml())
        for number in range(seeds)
        for link in links
        for strategy in strategies
    ]


def _met(scenario: Scenario, link: Overrides, strategy: str, number: int) -> Scenario:
    plain: Overrides = {"seed": scenario.seed + number, "link.plan": 0, "link.playout": {}}
    there = changed(scenario, {**link, **plain})
    how = STRATEGIES[strategy]
    return changed(there, {**how.keys, **(bounds(there) if how.played_out else {})})


def bounds(scenario: Scenario) -> Overrides:
    """Of a play-out for which all but a hundredth of the frames that get through are in time."""
    Ts, link, fates = scenario.sample_time, scenario.link, link_fates(scenario)
    ticks = min(scenario.must_end(), MOST_TRIED)
    found: dict[str, object] = {}
    delays = link.command_delay, link.measurement_delay
    for direction, delay in zip(DIRECTIONS, delays, strict=True):
        late = _late(fates[direction], ticks, Ts) if direction in fates else 0
        found[f"link.playout.{direction}"] = delay + late
    return found


def _late(fates: Fates, ticks: int, Ts: float) -> int:
    """By how many ticks frames are late that are in time."""
    tried = [fates.of(k, k * Ts, A_FRAME) for k in range(ticks)]
    extra = [copy.extra for copies in tried for copy in copies if copy.kind is FateKind.DELIVERED]
    sent = Ts * np.arange(len(extra), dtype=np.float64)
    return bound_for(Flow(sent, np.array(extra, dtype=np.float64), len(A_FRAME)), Ts, LATE)


def outcomes(jobs: Sequence[Trial], workers: int) -> Iterator[Fared]:
    """As they are done. Raises RunError."""
    return shared_out(tried, jobs, workers)


def tried(trial: Trial) -> Fared:
    """In a worker: one run."""
    scenario = Scenario.from_toml(trial.scenario)
    done = run(scenario)
    with np.errstate(all="ignore"):  # what diverges overflows
        judged = judged_run(done)
        driven = np.hypot(*np.diff(robot_pose(done.trace)[:, :2], axis=0).T).sum()
        rms = np.hypot(judged.rms_x[0], judged.rms_y[0])
    return Fared(
        trial.link,
        trial.strategy,
        bool(judged.converged[0]),
        _finite(judged.settled_s[0]),
        _finite(rms),
        float(driven),
    )


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
