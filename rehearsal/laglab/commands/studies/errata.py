"""``laglab errata``."""

from functools import partial
from typing import Annotated

import typer

from laglab.commands.on_scenario import on_scenario
from laglab.commands.options import WorkersOption
from laglab.extras import STEPPING, require
from laglab.progress import tracked
from laglab.scenario import Scenario
from laglab.studies.errata import VARIANTS, costs, costs_table, noisy
from laglab.tables import terminal


@partial(on_scenario, by_default="fig8", estimators=False)
def errata(
    scenario: Scenario,
    seeds: Annotated[int, typer.Option(min=1, help="Runs with noise, for each version.")] = 5,
    workers: WorkersOption = 0,
) -> None:
    """Run the paper's filter as printed beside it as corrected.

    One misprint at a time, and all of them.
    """
    require(STEPPING)
    scenario.must_end()
    noisy(scenario, seeds - 1)  # the last is one, too
    got = dict(tracked(costs(scenario, seeds, workers), len(VARIANTS), "errata", "version"))
    terminal().print(costs_table(scenario, [got[variant] for variant in VARIANTS]))
