"""``laglab trust``."""

import os
from pathlib import Path
from typing import Annotated

import typer

from laglab.errors import ScenarioError
from laglab.extras import REHEARSING, require
from laglab.progress import tracked
from laglab.results.figures import picture_place, save
from laglab.scenario.tables.names import known_estimator
from laglab.studies.trust import CONDITIONS, DEFAULT, fared, stations
from laglab.studies.trust_report import draw_trust, scores, trust_table
from laglab.tables import terminal
from laglab_control import ESTIMATORS


def trust(
    seeds: Annotated[int, typer.Option(min=1, max=10_000, help="Runs of each.")] = 20,
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="CONDITION", help="Just this one.")
    ] = None,
    estimator: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help=f"The filter of the first station: {', '.join(ESTIMATORS)}.",
            autocompletion=lambda: list(ESTIMATORS),
        ),
    ] = DEFAULT,
    workers: Annotated[int, typer.Option(min=0, max=256, help="Processes; 0: one a core.")] = 0,
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The picture.")] = Path(
        "trust.png"
    ),
) -> None:
    """Try how far each station can be trusted.

    On bad links, with a worn robot, when it is moved: the guarded default station beside popf with
    a guard and the filters without one.
    """
    require(REHEARSING)
    picture_place(out)
    conditions = [_known(name) for name in only or CONDITIONS]
    try:
        known_estimator(estimator)
    except ValueError as error:
        raise ScenarioError(f"--estimator: {error}") from None
    compared = stations(estimator)
    total = len(conditions) * len(compared) * seeds
    runs = fared(conditions, compared, seeds, workers or os.cpu_count() or 1)
    got = scores(list(tracked(runs, total, "trust", "run")))
    console = terminal()
    console.print(trust_table(got, list(compared), seeds))
    save(draw_trust(got, list(compared)), out)
    console.print(f"picture in {out}", highlight=False)


def _known(name: str) -> str:
    if name not in CONDITIONS:
        raise ScenarioError(f"--only: {name!r} is not one of {', '.join(CONDITIONS)}")
    return name
