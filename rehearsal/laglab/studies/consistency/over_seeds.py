"""How consistent a filter is, over seeds that are judged one after the other.

What is kept of them does not grow with their number.
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.results.numbers import mean_of_known
from laglab.studies.consistency.judging import Sample
from laglab_control import chi_square_bound

Array = NDArray[np.float64]
DEGREES = 3
CONFIDENCE = 0.95
INSIDE = 0.9
"""The share of ticks that must be within the bounds. 0.95 is expected, but successive averages of
NEES hang together, so that the share itself scatters."""


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


class Consistency(NamedTuple):
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
    """The share of ticks at which P is not positive definite; NaN where nothing is claimed."""
    diverged: int
    """Seeds."""
    measured: int
    """Ticks of all seeds at which measurements came."""
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


class _Running:
    """The mean of what is known of arrays that come one after the other; of a shorter one the rest
    is not known."""

    def __init__(self, *shape: int) -> None:
        self._sum, self._known = np.zeros(shape), np.zeros(shape)

    def add(self, values: Array) -> None:
        """The next."""
        there = ~np.isnan(values)
        self._sum[: len(values)] += np.where(there, values, 0.0)
        self._known[: len(values)] += there

    @property
    def average(self) -> Average:
        """So far."""
        with np.errstate(invalid="ignore"):
            return Average(self._sum / self._known, self._known)


class _Sums:
    """One filter over seeds; each counts up to where it diverged."""

    def __init__(self, estimator: str, last_tick: int, measurement_delay: int) -> None:
        """`last_tick`: of a run where nothing diverges."""
        self._estimator, self._delay = estimator, measurement_delay
        self._ticks = ticks = last_tick + 1 - measurement_delay
        self._nees, self._nis, self._nees_ahead = (_Running(ticks) for _ in range(3))
        self._variances, self._squares = _Running(ticks, DEGREES), _Running(ticks, DEGREES)
        self._of_runs: list[float] = []
        self._claimed = self._indefinite = self._diverged = self._measured = 0

    @np.errstate(over="ignore")  # of a filter that diverges
    def add(self, sample: Sample) -> None:
        """The next seed."""
        error, variances, nees, nis, nees_ahead = (each[self._delay :] for each in sample[:-1])
        self._nees.add(nees)
        self._nis.add(nis)
        self._nees_ahead.add(nees_ahead)
        self._variances.add(variances)
        self._squares.add(error**2)
        self._of_runs.append(float(mean_of_known(nees)))
        self._measured += int(sample.came.sum())
        alive, claimed = ~np.isnan(error[:, 0]), ~np.isnan(variances[:, 0])
        self._claimed += int(claimed.sum())
        self._indefinite += int(np.isnan(nees[claimed]).sum())
        self._diverged += len(alive) < self._ticks or not alive[-1]

    def consistency(self) -> Consistency:
        """On all of them."""
        return Consistency(
            self._estimator,
            nees=self._nees.average,
            nis=self._nis.average,
            nees_ahead=self._nees_ahead.average,
            of_runs=np.array(self._of_runs),
            claimed=np.sqrt(np.maximum(self._variances.average.values, 0)),
            true=np.sqrt(self._squares.average.values),
            indefinite=self._indefinite / self._claimed if self._claimed else np.nan,
            diverged=self._diverged,
            measured=self._measured,
            bounds=chi_square_bounds(len(self._of_runs)),
        )


def consistencies(
    names: Sequence[str], seeds: Iterable[Mapping[str, Sample]], last_tick: int, m: int
) -> list[Consistency]:
    """On the filters of these names, of all seeds; `last_tick`: of a run where nothing diverges."""
    sums = {name: _Sums(name, last_tick, m) for name in names}
    for samples in seeds:
        for name, of_one in sums.items():
            of_one.add(samples[name])
    return [of_one.consistency() for of_one in sums.values()]
