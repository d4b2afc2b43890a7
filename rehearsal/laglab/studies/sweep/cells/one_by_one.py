"""A cell's runs, one after the other, each as `laglab run --transport inline` makes it."""

from laglab.errors import RunError
from laglab.interface import run
from laglab.scenario import Scenario
from laglab.studies.judged import Judgements, joined, judged_run
from laglab.studies.sweep.cells.cell import Cell

ENDINGS = ("completed", "diverged")


def one_by_one(cell: Cell) -> Judgements:
    """What became of every seed. Raises RunError."""
    return joined([judged_alone(scenario) for scenario in cell.runs()])


def judged_alone(scenario: Scenario) -> Judgements:
    """What became of one run. Raises RunError."""
    done = run(scenario)
    if done.summary.outcome not in ENDINGS:
        raise RunError(f"{scenario.name}, seed {scenario.seed}: {done.summary.verdict}")
    return judged_run(done)
