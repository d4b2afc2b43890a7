"""``laglab reproduce``."""

import os
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from laglab.errors import ScenarioError
from laglab.extras import REHEARSING, require
from laglab.progress import tracked
from laglab.results.writable import folder_place
from laglab.studies.reproduce import CLAIMS, Entry, entries, trying, write_report
from laglab.tables import plain_table, terminal


def reproduce(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="The folder for the report.")
    ] = Path("reproduce"),
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="CLAIM", help="Just this one.")
    ] = None,
    workers: Annotated[int, typer.Option(min=0, max=256, help="Processes; 0: one a core.")] = 0,
) -> None:
    """Try every figure and claim of the paper, and say which hold.

    The report is one page with everything in it, and the same as Markdown with its pictures.
    """
    require(REHEARSING)
    names = [_known(name) for name in only or CLAIMS]
    folder_place("--out", out)
    findings = list(
        tracked(trying(names, workers or os.cpu_count() or 1), len(names), "reproduce", "claim")
    )
    console = terminal()
    console.print(_table(entries(findings)))
    page, markdown = write_report(findings, out)
    console.print(f"report in {page} and {markdown}", highlight=False)


def _known(name: str) -> str:
    if name not in CLAIMS:
        raise ScenarioError(f"--only: {name!r} is not one of {', '.join(CLAIMS)}")
    return name


def _table(of: list[Entry]) -> Table:
    table = plain_table("claim", "where", "verdict")
    for entry in of:
        table.add_row(entry.claim.name, entry.claim.place, f"{entry.sign} {entry.spelled}")
    return table
