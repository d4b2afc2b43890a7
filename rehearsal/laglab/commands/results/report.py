"""`laglab report`."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import RunsArgument
from laglab.extras import SEEING, require
from laglab.files import file_place
from laglab.results.run import open_run


def report(
    runs: RunsArgument,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The page, one HTML file.")
    ] = Path("report.html"),
) -> None:
    """Make one page of runs, side by side, that needs no internet.

    The robot moves under a slider, with its uncertainty and the commands in flight.
    """
    require(SEEING)
    from laglab.results.report import MOST_RUNS, save_report

    if len(runs) > MOST_RUNS:
        raise typer.BadParameter(f"{len(runs)} runs: a report shows {MOST_RUNS} beside each other")
    file_place("--out", out)
    save_report([open_run(directory) for directory in runs], out)
    print(out)
