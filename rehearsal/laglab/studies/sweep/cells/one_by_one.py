"""A cell's runs, one after the other, each as `laglab run --transport inline` makes it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from laglab.errors import RunError
from laglab.interface import run
from laglab.results.run import Run
from laglab.scenario import Scenario
from laglab.studies.judged import Array, Judgements, Record, joined, judgements, record_of
from laglab.studies.sweep.cells.cell import Cell
from laglab_control import Applied, Control, Controller, Echo, Measured

ENDINGS = ("completed", "diverged")


@dataclass(frozen=True, eq=False)
class Claiming(Controller):
    """The station's controller; what covariance it claims is kept, tick by tick."""

    claims: list[Array] = field(default_factory=list)
    """(3, 3) each; NaN where nothing is claimed."""

    def start(self) -> Control:
        """At tick 0."""
        self.claims.clear()
        return super().start()

    def answer(
        self,
        control: Control,
        measurements: Sequence[Measured],
        echoes: Sequence[Echo] = (),
        recalled: Sequence[Applied] = (),
    ) -> Control:
        """The same."""
        control = super().answer(control, measurements, echoes, recalled)
        self.claims.append(np.full((3, 3), np.nan) if control.P is None else control.P)
        return control


def one_by_one(cell: Cell) -> Judgements:
    """What became of every seed. Raises RunError."""
    return joined([judged_alone(scenario) for scenario in cell.runs()])


def judged_alone(scenario: Scenario) -> Judgements:
    """What became of one run. Raises RunError."""
    claims: list[Array] = []
    record = _record(run(scenario, controller=partial(Claiming, claims=claims)), claims)
    return judgements(record, scenario.target, scenario.link.m)


def _record(done: Run, claims: Sequence[Array]) -> Record:
    """Of one robot."""
    if done.summary.outcome not in ENDINGS:
        raise RunError(f"{done.scenario.name}, seed {done.scenario.seed}: {done.summary.verdict}")
    claimed = np.full((len(done.trace["tick"]), 3, 3), np.nan)
    claimed[: len(claims)] = claims[: len(claimed)]
    return record_of(done, claimed)
