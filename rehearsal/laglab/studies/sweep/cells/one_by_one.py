"""A cell's runs, one after the other, each as `laglab run --transport inline` makes it."""

from laglab.errors import LaglabError, RunError
from laglab.interface import run
from laglab.scenario import Scenario
from laglab.studies.judged import Judgements, joined, judged_run
from laglab.studies.sweep.cells.cell import Cell

ENDINGS = ("completed", "diverged")


def one_by_one(cell: Cell) -> Judgements:
    """What became of every seed. Raises RunError."""
    return joined([judged_alone(cell, scenario) for scenario in cell.runs()])


def judged_alone(cell: Cell, scenario: Scenario) -> Judgements:
    """What became of one of the cell's runs. Raises RunError, which says where in the grid."""
    try:
        done = run(scenario)
    except LaglabError as error:
        raise RunError(f"{_where(cell, scenario)}: {error}") from error
    if done.summary.outcome not in ENDINGS:
        raise RunError(f"{_where(cell, scenario)}: {done.summary.verdict}")
    return judged_run(done)


def _where(cell: Cell, scenario: Scenario) -> str:
    there = f"{cell.place}, " if cell.grid else ""
    return f"{there}seed {scenario.seed}"
