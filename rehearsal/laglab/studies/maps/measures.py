"""What a map shows of the runs in a cell: one number, how sure it is, and who is missing."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.studies.maps.runs import StudyRuns

EXACT = 1e-9
"""What is smaller is rounding, and told as 0."""
Z = 1.959964
"""The normal distribution's quantile of a two-sided 95 %."""


class Measure(NamedTuple):
    """A column, and how it is told."""

    column: str
    label: str
    share: bool = False
    """Yes or no, told as the share of yes; else as the median."""
    bad: bool = False
    """Whether yes is bad."""
    factor: float = 1.0
    """From the column's unit to the label's."""


OF_RUNS = "median of the runs"
KNOWN = (
    Measure("converged", "share of the runs\nthat converged", share=True),
    Measure("diverged", "share of the runs\nwhose estimate diverged", share=True, bad=True),
    Measure("settled_s", "settling time [s]\nmedian of those that settle"),
    Measure("rms_x", f"RMS error in x [mm]\n{OF_RUNS}", factor=1e3),
    Measure("rms_y", f"RMS error in y [mm]\n{OF_RUNS}", factor=1e3),
    Measure("rms_theta", f"RMS error in θ [mrad]\n{OF_RUNS}", factor=1e3),
    Measure("nees", f"NEES (3 where P is true)\n{OF_RUNS}"),
    Measure("final_rho", f"distance at the end [m]\n{OF_RUNS}"),
    Measure("final_theta_error", f"heading error at the end [rad]\n{OF_RUNS}"),
    Measure("alarm_s", "first alarm of the guard [s]\nmedian of those with one"),
    Measure("alarm_error", "error 2 s after the first alarm [mm]\nmedian", factor=1e3),
    Measure("max_v", f"largest speed [m/s]\n{OF_RUNS}"),
    Measure("max_omega", f"largest turn rate [rad/s]\n{OF_RUNS}"),
)


def measure(column: str) -> Measure:
    """One that is known, or any other column as it is called."""
    known = {each.column: each for each in KNOWN}
    return known.get(column, Measure(column, f"{column}\n{OF_RUNS}"))


class Interval(NamedTuple):
    """A number, and between what it lies at 95 %; NaN without runs."""

    centre: float
    low: float
    high: float


NONE = Interval(math.nan, math.nan, math.nan)


def share(yes: int, of: int) -> Interval:
    """The share, with Wilson's interval, which also holds near 0 and 1."""
    if not of:
        return NONE
    p, z = yes / of, Z**2 / of
    middle = (p + z / 2) / (1 + z)
    half = math.sqrt(p * (1 - p) * z + z**2 / 4) / (1 + z)
    low, high = min(middle - half, p), max(middle + half, p)  # but for rounding so at 0 and 1
    return Interval(p, max(low, 0.0), min(high, 1.0))


def median(values: NDArray[np.float64]) -> Interval:
    """The median, with the interval between two order statistics, whatever the distribution: the
    ranks are the binomial's, by its normal approximation."""
    known = np.sort(values[np.isfinite(values)])
    if not len(known):
        return NONE
    half = Z * math.sqrt(len(known)) / 2
    low = max(math.floor(len(known) / 2 - half), 0)
    return Interval(float(np.median(known)), float(known[low]), float(known[-1 - low]))


class Summed(NamedTuple):
    """All runs at a point of the grid."""

    runs: int
    diverged: int
    estimate: Interval


class MeasureValues(NamedTuple):
    """A measure of every run."""

    of: Measure
    values: NDArray[np.float64]
    diverged: NDArray[np.bool_]

    @classmethod
    def by(cls, runs: StudyRuns, column: str) -> MeasureValues:
        """That of a column; `diverged` needs none. Raises: StudyError, when there is none, or it
        has no numbers."""
        of, diverged = measure(column), runs.diverged
        if column == "diverged":
            return cls(of, diverged.astype(np.float64), diverged)
        values = runs.number(column)
        values[np.abs(values) < EXACT] = 0.0
        with np.errstate(over="ignore"):  # of a filter that diverges
            return cls(of, values * of.factor, diverged)

    @property
    def says_something(self) -> bool:
        """Whether there is anything to see."""
        return bool(np.nan_to_num(self.values).any())

    def summed(self, chosen: NDArray[np.intp]) -> Summed:
        """Of the runs with these numbers. One whose estimate diverged has no part in a median."""
        values, diverged = self.values[chosen], self.diverged[chosen]
        if self.of.share:
            known = values[~np.isnan(values)]
            estimate = share(int(np.count_nonzero(known)), len(known))
        else:
            estimate = median(values[~diverged])
        return Summed(len(chosen), int(diverged.sum()), estimate)
