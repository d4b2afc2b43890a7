"""Whether the covariance that a filter claims is the one its error has, over many seeds.

NEES is e^T P^-1 e of the estimate's error, NIS is v^T S^-1 v of the innovation. Of a consistent
filter both are chi-square with 3 degrees of freedom, so N times their average over N seeds has 3 N
of them: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation",
section 5.4.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from laglab.interface import run
from laglab.results.numbers import deviation
from laglab.runs.station_side import robot_model
from laglab.scenario import Scenario, changed
from laglab.studies.workers import shared_out
from laglab_control import ESTIMATORS, Replay, constant_delay, replay
from laglab_control.chi_square import chi_square_bound
from laglab_gateway import Trace

Array = NDArray[np.float64]
DEGREES = 3
CONFIDENCE = 0.95
INSIDE = 0.9
"""The share of ticks that must be within the bounds. 0.95 is expected, but successive averages of
NEES hang together, so that the share itself scatters."""


class Sample(NamedTuple):
    """One filter on the record of one seed, at every tick; NaN once it has diverged."""

    error: Array
    """(N+1, 3)."""
    variances: Array
    """(N+1, 3), the diagonal of P."""
    nees: Array
    """(N+1,); NaN where P is not positive definite."""
    nis: Array
    """(N+1,); NaN where nothing was measured."""


class Verdict(NamedTuple):
    """One filter over all seeds, ticks >= m."""

    estimator: str
    nees: Array
    """(N+1,), the average over the seeds at each tick."""
    nis: Array
    """(N+1,)."""
    claimed: Array
    """(N+1, 3), the standard deviations that P claims, root mean square over the seeds."""
    true: Array
    """(N+1, 3), those that the errors have."""
    indefinite: float
    """The share of ticks at which P is not positive definite."""
    diverged: int
    """Seeds."""
    bounds: tuple[float, float]
    """Of the average at one tick, at 95 %."""
    measurement_delay: int

    def mean(self, values: Array) -> float:
        """Over the ticks >= m."""
        return float(mean_of_known(values[self.measurement_delay :]))

    def inside(self, values: Array) -> float:
        """The share of the ticks >= m at which an average is within the bounds."""
        low, high = self.bounds
        settled = values[self.measurement_delay :]
        within = (low <= settled) & (settled <= high)
        return float(mean_of_known(np.where(np.isnan(settled), np.nan, within)))

    @property
    def consistent(self) -> bool:
        """The averages of NEES and NIS lie within the bounds, over all and at nearly every tick;
        P was always a covariance, and no seed diverged."""
        low, high = self.bounds
        within = all(
            low <= self.mean(values) <= high and self.inside(values) >= INSIDE
            for values in (self.nees, self.nis)
        )
        return within and not (self.indefinite or self.diverged)


def chi_square_bounds(seeds: int) -> tuple[float, float]:
    """Between which the average of NEES or NIS over the seeds lies with 95 % probability."""
    degrees = DEGREES * seeds
    tail = (1 - CONFIDENCE) / 2
    low, high = (chi_square_bound(above, degrees) / seeds for above in (1 - tail, tail))
    return low, high


def nth(scenario: Scenario, number: int) -> Scenario:
    """The scenario with the seed of that number; 0 is its own. Raises ScenarioError."""
    drawn = {"noise": True, "estimator.initial_estimate": "drawn"}
    return changed(scenario, {"seed": scenario.seed + number, **drawn})


class Job(Struct, frozen=True):
    """A seed to be judged."""

    scenario: str
    """As TOML."""
    estimators: tuple[str, ...]


class Judged(Struct, frozen=True):
    """What became of it: a `Sample` of each filter, its columns side by side."""

    samples: dict[str, bytes]


def samples(
    scenario: Scenario, estimators: Sequence[str], seeds: int, workers: int
) -> Iterator[dict[str, Sample]]:
    """Each seed's loop, and every filter on its record; in the order in which they are done.

    Raises: RunError, when a worker fails or dies.
    """
    jobs = [Job(nth(scenario, number).to_toml(), tuple(estimators)) for number in range(seeds)]
    for _, judged in shared_out(judge, jobs, workers):
        yield {name: _unpacked(table) for name, table in judged.samples.items()}


def judge(job: Job) -> Judged:
    """In a worker: one loop with the scenario's own filter, and every filter on its record."""
    scenario = Scenario.from_toml(job.scenario)
    trace = run(scenario).trace
    answer = {}
    for name in job.estimators:
        replayed = _reestimated(scenario, name, trace)
        error, P = deviation(trace, replayed.estimates), replayed.covariances
        variances = np.diagonal(P, axis1=1, axis2=2)
        answer[name] = np.column_stack((error, variances, _nees(error, P), replayed.nis)).tobytes()
    return Judged(answer)


def _unpacked(table: bytes) -> Sample:
    columns = np.frombuffer(table).reshape(-1, 8)
    return Sample(columns[:, :3], columns[:, 3:6], columns[:, 6], columns[:, 7])


def _reestimated(scenario: Scenario, name: str, trace: Trace) -> Replay:
    """What the named estimator makes of a record."""
    estimator = ESTIMATORS[name].make(robot_model(scenario))
    inputs = np.stack([trace["v"], trace["omega"]], axis=1)[:-1]
    measurements = np.stack([trace[f"{axis}_meas"] for axis in ("x", "y", "theta")], axis=1)
    return replay(
        estimator,
        scenario.first_estimate(),
        scenario.estimator.initial_covariance * np.eye(3),
        inputs,
        constant_delay(measurements, scenario.link.measurement_delay),
    )


def _nees(error: Array, P: Array) -> Array:
    nees = np.full(len(error), np.nan)
    for k, (e, covariance) in enumerate(zip(error, P, strict=True)):
        if np.all(np.isfinite(covariance)) and np.linalg.eigvalsh(covariance)[0] > 0:
            nees[k] = e @ np.linalg.solve(covariance, e)
    return nees


def verdict(name: str, of_seeds: Sequence[Sample], measurement_delay: int) -> Verdict:
    """All seeds of one filter together; a seed counts up to where it diverged."""
    length = max(len(one.nees) for one in of_seeds)
    error, variances, nees, nis = (
        np.stack([_padded(values, length) for values in column])
        for column in zip(*of_seeds, strict=True)
    )
    settled = slice(measurement_delay, None)
    alive = ~np.isnan(error[:, settled, 0])
    return Verdict(
        name,
        nees=mean_of_known(nees),
        nis=mean_of_known(nis),
        claimed=np.sqrt(np.maximum(mean_of_known(variances), 0)),
        true=np.sqrt(mean_of_known(error**2)),
        indefinite=float(mean_of_known(np.isnan(nees[:, settled])[alive].astype(np.float64))),
        diverged=int(np.sum(np.isnan(error[:, -1, 0]))),
        bounds=chi_square_bounds(len(of_seeds)),
        measurement_delay=measurement_delay,
    )


def _padded(values: Array, length: int) -> Array:
    missing = np.full((length - len(values), *values.shape[1:]), np.nan)
    return np.concatenate((values, missing))


def mean_of_known(values: Array) -> Array:
    """Along the first axis; NaN where there is no value."""
    there = ~np.isnan(values)
    with np.errstate(invalid="ignore", over="ignore"):
        mean: Array = np.where(there, values, 0).sum(axis=0) / there.sum(axis=0)
    return mean
