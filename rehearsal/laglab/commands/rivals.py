"""``laglab rivals``."""

import os
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.figure import WidthOption
from laglab.commands.options import on_scenario
from laglab.errors import ScenarioError
from laglab.extras import REHEARSING, require
from laglab.progress import tracked
from laglab.results.figures import picture_place, save
from laglab.runs.plant import check_plant
from laglab.runs.station_side import check_parts
from laglab.scenario import Scenario
from laglab.studies.rivals import LINKS, OWN_LINK, STRATEGIES, links_of, outcomes, trials
from laglab.studies.rivals_report import draw_rivals, rivals_table, scores
from laglab.tables import terminal


@partial(on_scenario, by_default="lab")
def rivals(
    scenario: Scenario,
    seeds: Annotated[int, typer.Option(min=1, max=10_000, help="Runs of each.")] = 20,
    on: Annotated[
        list[str] | None,
        typer.Option(
            "--on",
            metavar="LINK",
            help=f"Just this link; may be repeated: {', '.join(LINKS)}, or {OWN_LINK}.",
            autocompletion=lambda: [*LINKS, OWN_LINK],
        ),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only",
            metavar="STRATEGY",
            help=f"Just this one; may be repeated: {', '.join(STRATEGIES)}.",
            autocompletion=lambda: list(STRATEGIES),
        ),
    ] = None,
    workers: Annotated[int, typer.Option(min=0, max=256, help="Processes; 0: one a core.")] = 0,
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The picture.")] = Path(
        "rivals.png"
    ),
    width: WidthOption = "two",
) -> None:
    """Let the ways to live with a link meet on the same links.

    No filter, the paper's, the station of lab, play-out, plans: on links that jitter, lose, fall
    silent, and on the scenario's own, such as one that --timeline brings.
    """
    require(REHEARSING)
    picture_place(out)
    _can_be_repeated(scenario)
    links = _known("--on", on, links_of(scenario))
    strategies = _known("--only", only, STRATEGIES)
    jobs = trials(scenario, links, strategies, seeds)
    runs = outcomes(jobs, workers or os.cpu_count() or 1)
    got = scores(list(tracked(runs, len(jobs), "rivals", "run")))
    n, m = scenario.link.command_delay, scenario.link.measurement_delay
    title = f"{scenario.name}, n = {n}, m = {m}, {seeds} runs each"
    console = terminal()
    console.print(rivals_table(title, got, links, strategies))
    save(draw_rivals(title, got, links, strategies, width), out)
    console.print(f"picture in {out}", highlight=False)


def _can_be_repeated(scenario: Scenario) -> None:
    """Raises what `laglab run` would, and ScenarioError for a run that is another each time."""
    scenario.must_end()
    if scenario.pace != "lockstep":
        raise ScenarioError(f"{scenario.name}: pace: must be lockstep here, not {scenario.pace}")
    check_parts(scenario)
    check_plant(scenario)


def _known(option: str, named: Sequence[str] | None, known: Iterable[str]) -> list[str]:
    names = list(known)
    for name in named or ():
        if name not in names:
            raise ScenarioError(f"{option}: {name!r} is not one of {', '.join(names)}")
    return list(dict.fromkeys(named)) if named else names
