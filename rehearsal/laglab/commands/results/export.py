"""`laglab export`."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import RunArgument
from laglab.export import FormatName
from laglab.export import export as write
from laglab.progress import status
from laglab.results.run import open_run


def export(
    run: RunArgument,
    format: Annotated[  # noqa: A002 as it is on the command line
        FormatName, typer.Option("--format", help="What the other program reads.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="PATH", help="Where it goes; here, named as DIR is, otherwise."
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Take the place of what is at --out.")
    ] = False,
) -> None:
    """Write a run for other programs.

    As CSV, Parquet or MAT tables, or as ROS 2 messages in an MCAP file or a rosbag2 folder.
    """
    with status() as tell:
        tell(f"writing {format}")
        where = write(open_run(run), format, out, force)
    print(where)
