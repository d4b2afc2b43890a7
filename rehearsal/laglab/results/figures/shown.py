"""What a figure shows of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from laglab.errors import UndrawableError
from laglab.results.link_view import LinkView, link_view
from laglab.results.numbers import (
    VARIANCES,
    deviation,
    is_measured,
    loop_estimates,
    measurements,
    robot_pose,
    shadow_estimates,
)
from laglab.scenario import Scenario, Target
from laglab_gateway import CLAIMS_FILE, Trace

if TYPE_CHECKING:
    from laglab.results.run import Run

Array = NDArray[np.float64]

MINUTES, HOURS = 600.0, 3 * 3600.0
"""[s] Runs that last longer are told in minutes, or in hours."""


class Clock(NamedTuple):
    """A unit of time that suits a run's length."""

    seconds: float
    unit: str

    @property
    def label(self) -> str:
        """Of a time axis."""
        return f"t [{self.unit}]"


def clock(duration: float) -> Clock:
    """The one for a run of this `duration` [s]."""
    if duration > HOURS:
        return Clock(3600.0, "h")
    return Clock(60.0, "min") if duration > MINUTES else Clock(1.0, "s")


TOO_LARGE = 1e300
"""[m, rad] Beyond, an axis has no ends: twice as much is no number."""

GAP = 5.5
"""Ticks without a claim, of those that are drawn, are not drawn over; a slow station leaves out
some."""


class Shown(NamedTuple):
    """Time in the clock's unit; all else in SI units, as much of it as can be seen."""

    scenario: Scenario
    estimator: str
    """What is in the loop is called."""
    clock: Clock
    trace: Trace
    time: Array
    """(ticks,)"""
    claimed_time: Array
    """(claims,)"""
    claimed: Array
    """(claims, 3): the standard deviations that the station claims."""
    link: LinkView

    @property
    def pose(self) -> Array:
        """(ticks, 3), true, or measured where the true one is not known."""
        return robot_pose(self.trace)

    @property
    def measured(self) -> Array:
        """(ticks, 3)"""
        return measurements(self.trace)

    @property
    def estimate(self) -> Array:
        """(ticks, 3), of the estimator in the loop."""
        return loop_estimates(self.trace)

    @property
    def error(self) -> Array:
        """(ticks, 3): estimate less pose."""
        return deviation(self.trace, self.estimate)

    def shadow_error(self, name: str) -> Array:
        """(ticks, 3): the same of an estimator that shadowed the loop."""
        return deviation(self.trace, shadow_estimates(self.trace, name))

    @property
    def wanted(self) -> Array:
        """(ticks, 3): the goal, or where the path wanted the robot."""
        return self.target.poses(self.trace["tick"])

    @property
    def target(self) -> Target:
        """Where the robot was to be."""
        return self.scenario.target

    @property
    def is_estimated(self) -> bool:
        """Whether there is an estimate at all."""
        return not np.isnan(self.estimate).all()

    @property
    def is_measured(self) -> bool:
        """Whether the true pose is not known."""
        return is_measured(self.trace)

    @property
    def span(self) -> tuple[float, float]:
        """The first time and the last; never the same."""
        start, end = float(self.time[0]), float(self.time[-1])
        return start, end if end > start else start + self.scenario.sample_time


def broken(time: Array, rows: Array, longest: float) -> tuple[Array, Array]:
    """With a row of NaN wherever more than `longest` [s] lie between two: there a line breaks."""
    after = np.flatnonzero(np.diff(time) > longest) + 1
    return np.insert(time, after, time[after]), np.insert(rows, after, np.nan, axis=0)


def _refuse_too_large(run: Run, trace: Trace) -> None:
    """Raises UndrawableError; what is infinite is only left out."""
    for name, column in trace.items():
        if (np.isfinite(column) & (np.abs(column) > TOO_LARGE)).any():
            raise UndrawableError(
                f"{run.directory or run.summary.scenario} cannot be drawn: it has numbers that are "
                f"too large, in {name}; did it diverge, or is it damaged?"
            )


def shown(run: Run) -> Shown:
    """All that is drawn of it. Raises ResultsError, UndrawableError."""
    trace = run.drawn
    _refuse_too_large(run, trace)
    unit = clock(float(trace["time"][-1]))
    claims = run.drawn_table(CLAIMS_FILE)
    variances = np.stack([claims[name].astype(float) for name in VARIANCES], axis=1)
    time, variances = broken(
        claims["time"].astype(float), variances, GAP * run.stride * run.scenario.sample_time
    )
    return Shown(
        run.scenario,
        run.summary.estimator,
        unit,
        trace,
        trace["time"] / unit.seconds,
        time / unit.seconds,
        np.sqrt(np.maximum(variances, 0.0)),
        link_view(run),
    )
