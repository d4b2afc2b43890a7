"""``laglab trust``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import (
    PictureOption,
    SeedsOption,
    WorkersOption,
    checked,
    chosen,
    some_of,
)
from laglab.extras import REHEARSING, require
from laglab.progress import tracked
from laglab.results.figures import picture_place, save
from laglab.scenario.tables.names import known_estimator
from laglab.studies.trust import (
    CONDITIONS,
    DEFAULT,
    draw_trust,
    fared,
    scores,
    stations,
    trust_table,
)
from laglab.tables import terminal
from laglab_control import ESTIMATORS


def trust(
    seeds: SeedsOption = 20,
    only: Annotated[
        list[str] | None, some_of("--only", "CONDITION", "Just this one", list(CONDITIONS))
    ] = None,
    estimator: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help=f"The filter of the first station: {', '.join(ESTIMATORS)}.",
            autocompletion=lambda: list(ESTIMATORS),
        ),
    ] = DEFAULT,
    workers: WorkersOption = 0,
    out: PictureOption = Path("trust.png"),
) -> None:
    """Try how far each station can be trusted.

    On bad links, with a worn robot, when it is moved: the guarded default station beside popf with
    a guard and the filters without one.
    """
    require(REHEARSING)
    picture_place(out)
    conditions = chosen("--only", only, CONDITIONS)
    compared = stations(checked("--estimator", known_estimator, estimator))
    total = len(conditions) * len(compared) * seeds
    runs = fared(conditions, compared, seeds, workers)
    got = scores(list(tracked(runs, total, "trust", "run")))
    terminal().print(trust_table(got, list(compared), seeds))
    save(draw_trust(got, list(compared)), out)
    print(f"picture in {out}")
