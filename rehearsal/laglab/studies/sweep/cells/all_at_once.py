"""The runs of some cells, all at once: the fleet FMU and a batch of controllers."""

from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np

from laglab.errors import RunError
from laglab.runs.errors import SIDE_ERRORS
from laglab.scenario import Scenario
from laglab.scenario.tables.link import LinkTable
from laglab.studies.judged import Judge, Judgements, Stretch
from laglab.studies.many import Ticks, is_ideal, run_many
from laglab.studies.sweep.cells.cell import Cell
from laglab.studies.sweep.cells.one_by_one import judged_alone


def all_at_once(cells: Sequence[Cell]) -> list[Judgements]:
    """What became of every cell's seeds; where the batch cannot tell, as that run alone has it.

    Cells that differ in nothing but what the link does besides its delays are one batch: the wider
    it is, the less a robot costs in it. Raises RunError.
    """
    groups = defaultdict[tuple[bool, str], list[int]](list)
    for number, cell in enumerate(cells):
        groups[_in_common(cell.scenario)].append(number)
    judged: dict[int, Judgements] = {}
    for numbers in groups.values():
        together = _together([cells[number] for number in numbers])
        judged.update(zip(numbers, together, strict=True))
    return [judged[number] for number in range(len(cells))]


def _in_common(scenario: Scenario) -> tuple[bool, str]:
    """What robots of one batch have: whether their link is ideal, and all but its impairments."""
    if is_ideal(scenario):
        return True, scenario.model_dump_json()
    delays = scenario.link.model_dump(include={"command_delay", "measurement_delay"})
    return False, scenario.model_copy(update={"link": LinkTable(**delays)}).model_dump_json()


def _together(cells: Sequence[Cell]) -> Iterator[Judgements]:
    """One batch. Raises RunError, which says where in the grid."""
    runs = [(cell, run) for cell in cells for run in cell.runs()]
    scenario, scenarios = cells[0].scenario, [run for _, run in runs]
    judge = Judge(scenario.target, scenario.link.m, len(scenarios))
    try:
        ends = run_many(scenarios, lambda ticks: judge.add(_recorded(ticks)))
    except SIDE_ERRORS as error:  # the robots', which have all but their start in common
        raise RunError(f"{cells[0].place}: {error}") from error
    judged = judge.judgements(np.where(ends.diverged, ends.last_tick, np.nan))
    for robot in np.flatnonzero(ends.unsure):
        alone = judged_alone(*runs[robot])
        for column, value in zip(judged, alone, strict=True):
            column[robot] = value[0]
    first = 0
    for cell in cells:
        some = slice(first, first := first + len(cell.seeds))
        yield Judgements._make(column[some] for column in judged)


def _recorded(ticks: Ticks) -> Stretch:
    """Nothing after a run's end."""
    *rows, ended = ticks
    if ended.any():
        rows = [np.where(ended, np.nan, each) for each in rows]
    return Stretch(*[each.transpose(2, 1, 0) for each in rows])
