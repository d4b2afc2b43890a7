"""``laglab trust``."""

from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from laglab.commands.options import (
    PictureOption,
    SeedsOption,
    WorkersOption,
    checked,
    chosen,
    some_of,
)
from laglab.commands.studies.working import SchedulerOption, executor_of, kept_when_interrupted
from laglab.extras import REHEARSING, STUDYING, require
from laglab.results.figures import picture_place, save
from laglab.scenario.tables.names import known_estimator
from laglab.studies.trust import (
    CONDITIONS,
    DEFAULT,
    draw_trust,
    score,
    stations,
    studies,
    trust_table,
)
from laglab.tables import say, terminal
from laglab_control import ESTIMATORS

if TYPE_CHECKING:
    from laglab.studies.sweep.study import Study
    from laglab.studies.trust import Pair, Scores
    from laglab.studies.workers import Executor


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
    scheduler: SchedulerOption = None,
    keep: Annotated[
        Path, typer.Option(metavar="DIR", help="Where the runs' tables are kept.")
    ] = Path("studies/trust"),
    out: PictureOption = Path("trust.png"),
) -> None:
    """Try how far each station can be trusted.

    On bad links, with a worn robot, when it is moved: the guarded default station beside popf with
    a guard and the filters without one. What has been computed is kept: the same command goes on
    where the last one ended.
    """
    require(REHEARSING)
    require(STUDYING)
    picture_place(out)
    conditions = chosen("--only", only, CONDITIONS)
    compared = stations(checked("--estimator", known_estimator, estimator))
    tried = studies(conditions, compared, seeds)
    with executor_of(scheduler, workers) as executor:
        got = _tried(tried, keep, executor)
    terminal().print(trust_table(got, list(compared), seeds))
    save(draw_trust(got, list(compared)), out)
    print(f"picture in {out}")


def _tried(of: "Mapping[Pair, Study]", keep: Path, executor: "Executor") -> "Scores":
    """What became of every study, in their folder; what is there already is not made again."""
    from laglab.studies.sweep.folder import Folder
    from laglab.studies.sweep.sweeping import work_off
    from laglab.studies.sweep.work import work_left

    work = work_left(*of.values(), folder=Folder(keep))
    folder = Folder.of_cells(keep, "--keep")
    cells = list(chain.from_iterable(study.cells() for study in of.values()))
    runs = sum(study.runs for study in of.values())
    with kept_when_interrupted(runs, lambda: folder.runs(cells)):
        work_off("trust", cells, folder, executor, work)
    if made := runs - work.runs:
        say(f"{made} of {runs} runs had been made before, and are in {folder.cells}")
    return {pair: score(folder.table_of(study.cells())) for pair, study in of.items()}
