"""``laglab consistency``."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.on_scenario import on_scenario
from laglab.commands.options import PictureOption, WidthOption, WorkersOption, checked, some_of
from laglab.errors import ScenarioError
from laglab.extras import REHEARSING, require
from laglab.progress import tracked
from laglab.results.figures import picture_place, save
from laglab.scenario import Scenario
from laglab.scenario.tables.estimator import COMPARABLE, comparable
from laglab.studies.consistency import (
    consistencies,
    consistency_table,
    draw_consistency,
    nth,
    samples,
    unjudged,
)
from laglab.tables import say, terminal

JUDGED = ("ekf", "popf", "popf-exact", "delayed-ekf")
MOST_SEEDS = 10_000


@partial(on_scenario, by_default="lab")
def consistency(
    scenario: Scenario,
    seeds: Annotated[
        int, typer.Option(min=2, max=MOST_SEEDS, help="Runs, each with noise of its own.")
    ] = 50,
    judged: Annotated[
        list[str] | None,
        some_of("--judge", "NAME", "A filter to judge", COMPARABLE),
    ] = None,
    workers: WorkersOption = 0,
    out: PictureOption = Path("consistency.png"),
    width: WidthOption = "two",
) -> None:
    """Hold what each filter claims against its errors, over seeds.

    The loop runs with the scenario's filter; all filters are judged on its records.
    """
    require(REHEARSING)
    picture_place(out)
    names = [checked("--judge", comparable, name) for name in dict.fromkeys(judged or JUDGED)]
    _check(scenario, seeds)
    runs = samples(scenario, names, seeds, workers)
    shown = tracked(runs, seeds, "consistency", "seed")
    got = consistencies(names, shown, scenario.must_end(), scenario.link.m)
    terminal().print(consistency_table(scenario, got, seeds))
    for why in dict.fromkeys(filter(None, map(unjudged, got))):
        say(f"warning: {why}")
    save(draw_consistency(scenario, got, width), out)
    print(f"picture in {out}")


def _check(scenario: Scenario, seeds: int) -> None:
    """Raises: ScenarioError, when there is nothing to judge, or there are fewer seeds."""
    m = scenario.link.m
    if scenario.must_end() < m:
        raise ScenarioError(f"{scenario.name}: the run is over before a measurement has arrived")
    nth(scenario, seeds - 1)
