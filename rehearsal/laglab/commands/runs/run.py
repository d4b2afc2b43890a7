"""`laglab run`."""

from dataclasses import replace
from functools import partial
from typing import Annotated

import typer

from laglab.commands.on_scenario import on_scenario
from laglab.commands.options import (
    ForceOption,
    KeyOption,
    OutOption,
    PlantKeyOption,
    PlantOption,
    ReportOption,
)
from laglab.commands.runs.leaving import Wishes, leaving
from laglab.commands.runs.live import LiveOption, OpenOption
from laglab.errors import ScenarioError
from laglab.extras import REHEARSING, require
from laglab.progress import progress_of
from laglab.results.complete import Manner
from laglab.runs.plant import check_plant
from laglab.runs.rehearse import Transport
from laglab.runs.robot_side import Setup, wrapped_replay
from laglab.runs.station_side import check_parts
from laglab.runs.waiting import in_time
from laglab.runs.whole import run_into
from laglab.scenario import Scenario
from laglab.tables import say
from laglab_control import is_module_class


@on_scenario
def run(
    scenario: Scenario,
    transport: Annotated[
        Transport, typer.Option(help="What is between the two processes; inline is one process.")
    ] = "udp",
    out: OutOption = None,
    force: ForceOption = False,
    key: KeyOption = None,
    plant: PlantOption = None,
    plant_key: PlantKeyOption = None,
    report: ReportOption = False,
    live: LiveOption = None,
    open_: OpenOption = False,
) -> None:
    """Rehearse SCENARIO: robot, delayed link and controller.

    Two processes, or one; the records, and the verdict.
    """
    require(REHEARSING)
    wishes = Wishes(out, force, report, live, open_)
    wishes.check()
    if plant is not None and transport == "inline":
        raise ScenarioError("--plant: a real robot does not wait: take --transport udp or serial")
    setup = Setup(plant, key, plant_key=plant_key)
    setup.check()
    in_time(_parts(scenario), partial(check_parts, scenario))
    if plant is None:
        in_time(scenario.plant.called, partial(check_plant, scenario))
    if said := wrapped_replay(scenario):
        say(said)
    manner = Manner("both", transport, plant or scenario.plant.called)
    with leaving(scenario, manner, wishes) as left:
        with progress_of(scenario) as told:
            setup = replace(setup, live=left.line, last=left.last)
            ending = run_into(left.directory, scenario, transport, told, setup)
        code = left.conclude(ending)
    raise typer.Exit(code)


def _parts(scenario: Scenario) -> str:
    """The parts of the run that somebody else may have written."""
    kinds = (scenario.estimator.kind, *scenario.estimator.compare, scenario.law.kind)
    return " or ".join([kind for kind in kinds if is_module_class(kind)] or kinds)
