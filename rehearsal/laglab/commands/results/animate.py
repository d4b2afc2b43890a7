"""`laglab animate`."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import RunsArgument
from laglab.extras import DRAWING, require
from laglab.results.figures import animation_place, save_animation
from laglab.results.run import open_run


def animate(
    runs: RunsArgument,
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The moving picture, a GIF.")
    ] = Path("runs.gif"),
) -> None:
    """Show runs beside each other as a moving picture.

    At the pace of the clock; long runs go faster.
    """
    require(DRAWING)
    animation_place(out)
    save_animation([open_run(directory) for directory in runs], out)
    print(out)
