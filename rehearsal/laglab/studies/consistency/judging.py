"""Whether the covariance that a filter claims is the one its error has, over many seeds.

What is judged is what the station really had in its loop, over the scenario's link: its estimates,
its innovations, and the prediction x̂_{k+n} by which it made its commands. Other filters are run
beside it on what it heard.

NEES is e^T P^-1 e of the estimate's error, NIS is v^T S^-1 v of the innovation. Of a consistent
filter both are chi-square with 3 degrees of freedom, so N times their average over N seeds has 3 N
of them: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation",
section 5.4.
"""

from collections.abc import Iterator, Sequence
from functools import cache, partial
from typing import NamedTuple

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from laglab.interface import run
from laglab.results.nees import nees
from laglab.results.numbers import mean_of_known, pose_difference, robot_pose
from laglab.scenario import Scenario, changed
from laglab.studies.overhearing import Known, Overhearing
from laglab.studies.workers import shared_out
from laglab_control import chi_square_bound
from laglab_gateway import Trace

Array = NDArray[np.float64]
DEGREES = 3
CONFIDENCE = 0.95
INSIDE = 0.9
"""The share of ticks that must be within the bounds. 0.95 is expected, but successive averages of
NEES hang together, so that the share itself scatters."""


class Sample(NamedTuple):
    """One filter in the loop of one seed, at every tick; NaN once it has diverged."""

    error: Array
    """(N+1, 3), of x̂_k."""
    variances: Array
    """(N+1, 3), the diagonal of P."""
    nees: Array
    """(N+1,); NaN where P is not positive definite."""
    nis: Array
    """(N+1,); NaN where nothing was measured."""
    nees_ahead: Array
    """(N+1,): of x̂_{k+n}, by which the command was made, when the robot was there."""


class Average(NamedTuple):
    """Of NEES or NIS over the seeds, at the ticks from m on."""

    values: Array
    """NaN where no seed has a value."""
    seeds: Array
    """How many have one."""

    @property
    def mean(self) -> float:
        """Over all ticks."""
        return float(mean_of_known(self.values))

    @property
    def inside(self) -> float:
        """The share of the ticks at which the average is within the bounds for its seeds."""
        low, high = np.array([chi_square_bounds(int(n)) for n in self.seeds]).T
        within = (low <= self.values) & (self.values <= high)
        return float(mean_of_known(np.where(self.seeds == 0, np.nan, within)))


class Verdict(NamedTuple):
    """One filter over all seeds, ticks >= m."""

    estimator: str
    nees: Average
    nis: Average
    nees_ahead: Average
    """Of the prediction x̂_{k+n}."""
    of_runs: Array
    """(seeds,): each run's own NEES, averaged over its ticks."""
    claimed: Array
    """(N+1-m, 3), the standard deviations that P claims, root mean square over the seeds."""
    true: Array
    """(N+1-m, 3), those that the errors have."""
    indefinite: float
    """The share of ticks at which P is not positive definite."""
    diverged: int
    """Seeds."""
    bounds: tuple[float, float]
    """Of the average of all seeds at one tick, at 95 %."""

    @property
    def consistent(self) -> bool:
        """The averages of NEES and NIS lie within the bounds, over all and at nearly every tick;
        P was always a covariance, and no seed diverged."""
        low, high = self.bounds
        within = all(
            low <= average.mean <= high and average.inside >= INSIDE
            for average in (self.nees, self.nis)
        )
        return within and not (self.indefinite or self.diverged)


@cache
def chi_square_bounds(seeds: int) -> tuple[float, float]:
    """Between which an average of NEES or NIS over `seeds` lies at 95 %; NaN without seeds."""
    if seeds == 0:
        return np.nan, np.nan
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


def samples(
    scenario: Scenario, estimators: Sequence[str], seeds: int, workers: int
) -> Iterator[dict[str, Sample]]:
    """Each seed's loop, and every filter on its record; in the order in which they are done.

    Raises: RunError, when a worker fails or dies.
    """
    jobs = [Job(nth(scenario, number).to_toml(), tuple(estimators)) for number in range(seeds)]
    return shared_out(judge, jobs, workers)


def judge(job: Job) -> dict[str, Sample]:
    """In a worker: one loop with the scenario's own filter, and the others beside it."""
    scenario = Scenario.from_toml(job.scenario)
    said: dict[str, list[Known]] = {}
    others = tuple(name for name in job.estimators if name != scenario.estimator.kind)
    done = run(scenario, controller=partial(Overhearing, others=others, said=said))
    return {name: judged(heard, done.trace) for name, heard in said.items()}


def judged(said: Sequence[Known], trace: Trace) -> Sample:
    """What a filter said at the ticks of a run, beside where the robot was."""
    pose = robot_pose(trace)
    x, P, nis, ahead, P_ahead, n = (np.array(column) for column in zip(*said, strict=True))
    error = pose_difference(x, pose[: len(x)])
    arrival = np.arange(len(x)) + n
    there = np.where((arrival < len(pose))[:, np.newaxis], pose[arrival % len(pose)], np.nan)
    variances = np.diagonal(P, axis1=1, axis2=2)
    ahead_error = pose_difference(ahead, there)
    return Sample(error, variances, nees(error, P), nis, nees(ahead_error, P_ahead))


def verdict(name: str, of_seeds: Sequence[Sample], measurement_delay: int) -> Verdict:
    """All seeds of one filter together; a seed counts up to where it diverged."""
    length = max(len(one.nees) for one in of_seeds)
    error, variances, nees, nis, nees_ahead = (
        np.stack([_padded(values, length)[measurement_delay:] for values in column])
        for column in zip(*of_seeds, strict=True)
    )
    alive = ~np.isnan(error[:, :, 0])
    return Verdict(
        name,
        nees=_average(nees),
        nis=_average(nis),
        nees_ahead=_average(nees_ahead),
        of_runs=mean_of_known(nees.T),
        claimed=np.sqrt(np.maximum(mean_of_known(variances), 0)),
        true=np.sqrt(mean_of_known(error**2)),
        indefinite=float(mean_of_known(np.isnan(nees)[alive].astype(np.float64))),
        diverged=int(np.sum(~alive[:, -1])),
        bounds=chi_square_bounds(len(of_seeds)),
    )


def _average(values: Array) -> Average:
    return Average(mean_of_known(values), np.sum(~np.isnan(values), axis=0))


def _padded(values: Array, length: int) -> Array:
    missing = np.full((length - len(values), *values.shape[1:]), np.nan)
    return np.concatenate((values, missing))
