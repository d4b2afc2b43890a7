"""``laglab sweep``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import WorkersOption
from laglab.commands.studies.working import SchedulerOption, executor_of, kept_when_interrupted
from laglab.extras import SEEING, STUDYING, require
from laglab.results.place import REPORT_FILE
from laglab.scenario import assignment
from laglab.tables import plain_table, say, terminal


def sweep(
    study: Annotated[
        str | None,
        typer.Argument(metavar="STUDY", help="A shipped study's name, or a TOML file."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Where the results go; studies/STUDY otherwise."),
    ] = None,
    seeds: Annotated[
        int | None, typer.Option(min=1, max=2**31 - 1, help="So many, whatever the study says.")
    ] = None,
    told: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="A key of its scenario; may be repeated."),
    ] = None,
    workers: WorkersOption = 0,
    scheduler: SchedulerOption = None,
    force: Annotated[bool, typer.Option("--force", help="Compute again what is there.")] = False,
    limit: Annotated[int, typer.Option(min=1, help="The most runs that are meant.")] = 1_000_000,
    report: Annotated[
        bool, typer.Option("--report", help="Leave report.html, too: its maps, to be zoomed.")
    ] = False,
) -> None:
    """Run a scenario over a grid of its keys, and over seeds.

    Without STUDY, list those that come with laglab. What has been computed is kept: the same
    command goes on where the last one ended.
    """
    if study is None:
        _list()
        return
    require(STUDYING)
    if report:
        require(SEEING)
    from laglab.studies.sweep.folder import Folder
    from laglab.studies.sweep.loading import load_study
    from laglab.studies.sweep.report import strangers_told, summary
    from laglab.studies.sweep.sweeping import work_off
    from laglab.studies.sweep.work import checked_work

    workforce = executor_of(scheduler, workers)
    chosen = load_study(study, dict(map(assignment, told or [])), seeds)
    place = out or Path("studies") / chosen.name
    work = checked_work(chosen, None if force else Folder(place), limit)
    with workforce as executor:
        folder = Folder.made(place, chosen)
        for line in strangers_told(chosen, folder):
            say(line)
        with kept_when_interrupted(chosen.runs, lambda: folder.runs(chosen.cells())):
            work_off(chosen.name, chosen.cells(), folder, executor, work, again=force)
    said = summary(chosen, folder, work)
    terminal().print(said, highlight=False)
    if report:
        from laglab.studies.maps.page import save_study_page

        save_study_page(chosen, folder.path, said.splitlines(), folder.path / REPORT_FILE)
        print(f"report in {folder.path / REPORT_FILE}")


def _list() -> None:
    from laglab.studies.sweep.loading import shipped_studies

    table = plain_table("name", "runs", "over", "what it shows")
    for name, study in shipped_studies().items():
        table.add_row(name, str(study.runs), ", ".join(study.grid), study.description)
    terminal().print(table)
