"""Where each station still gets the robot to its goal: on bad links, with a robot that is not the
model's, and when somebody moves it."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from msgspec import Struct

from laglab.interface import run
from laglab.results.numbers import deviation, loop_estimates
from laglab.results.run import Run
from laglab.scenario import Overrides, Scenario, both_ways, changed, load
from laglab.studies.consistency import judged
from laglab.studies.overhearing import Known, Overhearing
from laglab.studies.workers import shared_out

DEFAULT = "delayed-ekf"
"""The filter of `lab*`, which is guarded there."""
STOCK = ("delayed-ekf", "popf", "ekf")
"""Compared as they are."""
MOVED_AT = 5.0
"""[s] When somebody moves the robot by half a metre."""
LOOKED_AT_AFTER = 2.0
"""[s] How long after the first alarm the error is looked at."""


JITTER = {"distribution": "exponential", "mean": 0.05}
OUTAGES = [{"at": at, "duration": 1.0, "link": {"loss": 1.0}} for at in (2.0, 6.0)]
EVERYTHING = both_ways(
    loss=0.3, extra_delay=JITTER, reorder=0.2, duplicate=0.02, bit_error_rate=1e-5, bandwidth=115200
)


Station = dict[str, str | bool]
"""What makes a station: scenario keys."""


class Condition(NamedTuple):
    """A scenario, and what is different."""

    scenario: str
    overrides: Overrides


CONDITIONS: Mapping[str, Condition] = {
    "lab": Condition("lab", {}),
    "lab-radio": Condition("lab-radio", {}),
    "lab-real": Condition("lab-real", {}),
    "30 % loss": Condition("lab", both_ways(loss=0.3)),
    "50 ms jitter": Condition("lab", both_ways(extra_delay=JITTER)),
    "20 % reordered": Condition("lab", both_ways(reorder=0.2)),
    "two outages of 1 s": Condition("lab", {"link.event": OUTAGES}),
    "all of these": Condition("lab", {**EVERYTHING, "link.event": OUTAGES}),
    "wheels 10 % large": Condition("lab", {"plant.wheel_radius_error": 0.1}),
    "wheels 10 % small": Condition("lab", {"plant.wheel_radius_error": -0.1}),
    "track 10 % wide": Condition("lab", {"plant.track_error": 0.1}),
    "track 10 % narrow": Condition("lab", {"plant.track_error": -0.1}),
    "moved by 0.5 m": Condition("lab", {"plant.event": [{"at": MOVED_AT, "by": [0.3, -0.4, 0.0]}]}),
}


class Trial(Struct, frozen=True):
    """One run."""

    condition: str
    station: str
    how: Station
    seed: int

    @property
    def scenario(self) -> Scenario:
        """What is run."""
        base, different = CONDITIONS[self.condition]
        scenario = load(base, {**different, **self.how, "seed": self.seed})
        popf = scenario.estimator.kind.startswith("popf")
        return changed(scenario, {"estimator.initial_covariance": 1e-4}) if popf else scenario


class Fared(Struct, frozen=True):
    """How it fared."""

    condition: str
    station: str
    converged: bool
    rms: tuple[float, float, float] | None
    """Of the estimate [m, m, rad]; None when there was none."""
    nees: float | None
    """Averaged over the ticks >= m; None where nothing was claimed."""
    alarmed: bool
    """Whether the guard raised an alarm."""
    late_error: float | None
    """[m] LOOKED_AT_AFTER after the first alarm; None without one, or when the run was over."""


def stations(default: str) -> dict[str, Station]:
    """The default station, `popf` with a guard, and the filters as they are."""
    return {
        f"{default}, guarded": {"estimator.kind": default, "estimator.guard": True},
        "popf, guarded": {"estimator.kind": "popf", "estimator.guard": True},
        **{name: {"estimator.kind": name, "estimator.guard": False} for name in STOCK},
    }


def fared(
    conditions: Sequence[str],
    compared: Mapping[str, Station],
    seeds: int,
    workers: int,
) -> Iterator[Fared]:
    """Every condition with every station and seed, as they are done. Raises RunError."""
    trials = [
        Trial(condition, station, how, seed)
        for seed in range(1, seeds + 1)
        for condition in conditions
        for station, how in compared.items()
    ]
    return shared_out(tried, trials, workers)


def tried(trial: Trial) -> Fared:
    """In a worker: one run."""
    scenario = trial.scenario
    said: dict[str, list[Known]] = {}
    done = run(scenario, controller=partial(Overhearing, said=said))
    nees = judged(said[scenario.estimator.kind], done.trace).nees[scenario.link.m :]
    rms = done.summary.rms_error
    return Fared(
        trial.condition,
        trial.station,
        done.summary.converged,
        (rms.x, rms.y, rms.theta) if rms else None,
        float(np.nanmean(nees)) if np.isfinite(nees).any() else None,
        bool(done.alarms),
        _late_error(done),
    )


def _late_error(done: Run) -> float | None:
    if not done.alarms:
        return None
    off = deviation(done.trace, loop_estimates(done.trace))
    tick = done.alarms[0] + round(LOOKED_AT_AFTER / done.scenario.sample_time)
    return float(np.hypot(*off[tick, :2])) if tick < len(off) else None
