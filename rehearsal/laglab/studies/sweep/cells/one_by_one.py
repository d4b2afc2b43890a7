"""A cell's runs, one after the other, each as `laglab run --transport inline` makes it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from laglab.errors import RunError
from laglab.interface import run
from laglab.scenario import Scenario
from laglab.studies.judged import Array, Judgements, joined, judged_run
from laglab.studies.sweep.cells.cell import Cell
from laglab_control import Applied, Control, Controller, Echo, Measured

ENDINGS = ("completed", "diverged")


@dataclass(frozen=True, eq=False)
class Claiming(Controller):
    """The station's controller; what covariance it claims is kept, tick by tick."""

    claims: list[Array] = field(default_factory=list)
    """(6,) each, the upper triangle; NaN where nothing is claimed."""

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
        P = np.full((3, 3), np.nan) if control.P is None else control.P
        self.claims.append(P[np.triu_indices(3)])
        return control


def one_by_one(cell: Cell) -> Judgements:
    """What became of every seed. Raises RunError."""
    return joined([judged_alone(scenario) for scenario in cell.runs()])


def judged_alone(scenario: Scenario) -> Judgements:
    """What became of one run. Raises RunError."""
    claims: list[Array] = []
    done = run(scenario, controller=partial(Claiming, claims=claims))
    if done.summary.outcome not in ENDINGS:
        raise RunError(f"{scenario.name}, seed {scenario.seed}: {done.summary.verdict}")
    claimed = np.full((len(done.trace["tick"]), 6), np.nan)
    claimed[: len(claims)] = claims[: len(claimed)]
    return judged_run(done, claimed)
