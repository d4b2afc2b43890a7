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
from functools import partial
from typing import NamedTuple

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from laglab.interface import run
from laglab.results.nees import nees
from laglab.results.numbers import pose_difference, robot_pose
from laglab.scenario import Scenario, changed
from laglab.studies.overhearing import Known, Overhearing
from laglab.studies.workers import shared_out
from laglab_gateway import Trace

Array = NDArray[np.float64]


class Sample(NamedTuple):
    """One filter in the loop of one seed, at every tick; NaN once it has diverged."""

    error: Array
    """(N+1, 3), of x̂_k."""
    variances: Array
    """(N+1, 3), the diagonal of P; NaN where nothing is claimed."""
    nees: Array
    """(N+1,); NaN where P is not positive definite."""
    nis: Array
    """(N+1,); NaN where nothing was measured."""
    nees_ahead: Array
    """(N+1,): of x̂_{k+n}, by which the command was made, when the robot was there."""
    came: NDArray[np.bool_]
    """(N+1,): whether measurements came."""


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
    x, P, nis, ahead, P_ahead, n, came = (np.array(column) for column in zip(*said, strict=True))
    error = pose_difference(x, pose[: len(x)])
    arrival = np.arange(len(x)) + n
    there = np.where((arrival < len(pose))[:, np.newaxis], pose[arrival % len(pose)], np.nan)
    variances = np.diagonal(P, axis1=1, axis2=2)
    ahead_error = pose_difference(ahead, there)
    return Sample(error, variances, nees(error, P), nis, nees(ahead_error, P_ahead), came)
