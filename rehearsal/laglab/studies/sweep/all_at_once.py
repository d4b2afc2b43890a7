"""A cell's runs, all at once: the fleet FMU and a batch of controllers."""

import numpy as np

from laglab.studies.many import Many, run_many
from laglab.studies.sweep.cell import Cell
from laglab.studies.sweep.judged import Judgements, Record, judgements
from laglab.studies.sweep.one_by_one import judged_alone

SQUARE = [[0, 1, 2], [1, 3, 4], [2, 4, 5]]
"""Where in an upper triangle the elements of a whole matrix are."""


def all_at_once(cell: Cell) -> Judgements:
    """What became of every seed; where the batch cannot tell, as that run alone has it.

    Raises RunError.
    """
    scenarios, scenario = list(cell.runs()), cell.scenario
    many = run_many(scenarios)
    m = scenario.link.measurement_delay
    judged = judgements(_record(many), scenario.goal, scenario.sample_time, m)
    for robot in np.flatnonzero(many.unsure):
        alone = judged_alone(scenarios[robot])
        for column, value in zip(judged, alone, strict=True):
            column[robot] = value[0]
    return judged


def _record(many: Many) -> Record:
    ticks = np.arange(len(many.truth))
    after = ticks[:, np.newaxis] > many.last_tick  # nothing was recorded there
    truth, estimates, P, applied = (
        np.where(after[:, np.newaxis], np.nan, each).transpose(2, 0, 1)
        for each in (many.truth, many.estimates, many.P, many.applied)
    )
    diverged = np.where(many.diverged, many.last_tick, np.nan)
    return Record(truth, estimates, P[..., SQUARE], applied, diverged)
