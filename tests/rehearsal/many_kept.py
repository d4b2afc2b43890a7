"""Many runs at once with all their ticks, to be held against the runs one by one."""

from typing import NamedTuple

import numpy as np

import laglab
from laglab.studies.many import Ends, Ticks, run_many

COLUMNS = ["x", "y", "theta", "x_est", "y_est", "theta_est", "v", "omega"]


class Kept(NamedTuple):
    """All that was told."""

    ends: Ends
    rows: np.ndarray
    """(8, ticks, robots): truth, estimates, speeds."""

    @property
    def truth(self):
        return self.rows[:3]


def kept(scenarios) -> Kept:
    """Of these runs; none is unsure."""
    pages = []

    def keep(ticks: Ticks) -> None:
        pages.append(np.concatenate((ticks.truth, ticks.estimates, ticks.applied)))

    ends = run_many(scenarios, keep)
    assert not ends.unsure.any()
    return Kept(ends, np.concatenate(pages, axis=1))


def furthest(many: Kept, robot: int, run: laglab.Run, last: int = 10**6) -> float:
    """Between the two, in pose, estimate and speeds, over the ticks up to `last`."""
    assert many.ends.last_tick[robot] + 1 == len(run.trace["x"])
    ticks = min(many.ends.last_tick[robot], last) + 1
    there = many.rows[:, :ticks, robot]
    one_by_one = np.stack([run.trace[name] for name in COLUMNS])[:, :ticks]
    assert (np.isnan(there) == np.isnan(one_by_one)).all()
    return float(np.nanmax(np.abs(there - one_by_one)))
