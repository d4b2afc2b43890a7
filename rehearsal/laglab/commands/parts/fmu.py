"""`laglab fmu`."""

from pathlib import Path
from typing import Annotated

import typer

import laglab_fmu
from laglab.commands.group import group
from laglab.extras import STEPPING, require
from laglab.files import folder_place
from laglab.progress import status

app = group("The robot as an FMU.")


@app.command()
def build(
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Where they go; else where laglab's are."),
    ] = None,
    all_platforms: Annotated[
        bool,
        typer.Option(
            "--all-platforms",
            help="For Linux, Windows and macOS, by ziglang; the first time takes minutes.",
        ),
    ] = False,
) -> None:
    """Build the FMUs of the robots that ship.

    For FMI 2 and 3, and for this machine or for all.
    """
    require(STEPPING)
    folder = folder_place("--out", out or Path(laglab_fmu.__file__).parent)
    with status() as tell:
        tell("compiling")
        built = laglab_fmu.build_fmus(folder, laglab_fmu.PLATFORMS if all_platforms else ())
    for path in built:
        print(path)
