"""``laglab rivals``."""

from functools import partial
from pathlib import Path
from typing import Annotated

from laglab.commands.on_scenario import on_scenario
from laglab.commands.options import (
    PictureOption,
    SeedsOption,
    WidthOption,
    WorkersOption,
    chosen,
    some_of,
)
from laglab.errors import ScenarioError
from laglab.extras import REHEARSING, require
from laglab.progress import tracked
from laglab.results.figures import picture_place, save
from laglab.runs.plant import check_plant
from laglab.runs.station_side import check_parts
from laglab.scenario import Scenario
from laglab.studies.rivals import (
    LINKS,
    OWN_LINK,
    STRATEGIES,
    draw_rivals,
    links_of,
    outcomes,
    rivals_table,
    scores,
    trials,
)
from laglab.tables import counted, terminal


@partial(on_scenario, by_default="lab", estimators=False)
def rivals(
    scenario: Scenario,
    seeds: SeedsOption = 20,
    on: Annotated[
        list[str] | None, some_of("--on", "LINK", "Just this link", [*LINKS, OWN_LINK])
    ] = None,
    only: Annotated[
        list[str] | None, some_of("--only", "STRATEGY", "Just this one", list(STRATEGIES))
    ] = None,
    workers: WorkersOption = 0,
    out: PictureOption = Path("rivals.png"),
    width: WidthOption = "two",
) -> None:
    """Let the ways to live with a link meet on the same links.

    No filter, the paper's, the station of lab, play-out, plans: on links that jitter, lose, fall
    silent, and on the scenario's own, such as one that --timeline brings.
    """
    require(REHEARSING)
    picture_place(out)
    _can_be_repeated(scenario)
    links = chosen("--on", on, links_of(scenario))
    strategies = chosen("--only", only, STRATEGIES)
    jobs = trials(scenario, links, strategies, seeds)
    runs = outcomes(jobs, workers)
    got = scores(list(tracked(runs, len(jobs), "rivals", "run")))
    n, m = scenario.link.command_delay, scenario.link.measurement_delay
    title = f"{scenario.name}, n = {n}, m = {m}, {counted(seeds, 'run')} each"
    terminal().print(rivals_table(title, got, links, strategies))
    save(draw_rivals(title, got, links, strategies, width), out)
    print(f"picture in {out}")


def _can_be_repeated(scenario: Scenario) -> None:
    """Raises what `laglab run` would, and ScenarioError for a run that is another each time."""
    scenario.must_end()
    if scenario.pace != "lockstep":
        raise ScenarioError(f"{scenario.name}: pace: must be lockstep here, not {scenario.pace}")
    check_parts(scenario)
    check_plant(scenario)
