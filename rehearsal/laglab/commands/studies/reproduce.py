"""``laglab reproduce``."""

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from laglab.commands.options import WorkersOption, chosen
from laglab.extras import REHEARSING, require
from laglab.files import folder_place
from laglab.progress import tracked
from laglab.studies.reproduce import CLAIMS, Entry, entries, trying, write_report
from laglab.tables import plain_table, terminal


def reproduce(
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="The folder for the report.")
    ] = Path("reproduce"),
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="CLAIM", help="Just this one.")
    ] = None,
    workers: WorkersOption = 0,
) -> None:
    """Try every figure and claim of the paper, and say which hold.

    The report is one page with everything in it, and the same as Markdown with its pictures.
    """
    require(REHEARSING)
    names = chosen("--only", only, CLAIMS)
    folder_place("--out", out)
    findings = list(tracked(trying(names, workers), len(names), "reproduce", "claim"))
    terminal().print(_table(entries(findings)))
    page, markdown = write_report(findings, out)
    print(f"report in {page} and {markdown}")


def _table(of: list[Entry]) -> Table:
    table = plain_table("claim", "where", "verdict")
    for entry in of:
        table.add_row(entry.claim.name, entry.claim.place, f"{entry.sign} {entry.spelled}")
    return table
