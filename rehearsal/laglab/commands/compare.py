"""`laglab compare`."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.figure import WidthOption
from laglab.extras import DRAWING, require
from laglab.results.figures import draw_runs, picture_place, save
from laglab.results.run import open_run


def compare(
    runs: Annotated[list[Path], typer.Argument(metavar="DIR...", help="What runs left.")],
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The picture: PNG, PDF, SVG and others.")
    ] = Path("compare.png"),
    width: WidthOption = "two",
) -> None:
    """Lay several runs over each other in one picture.

    On equal axes; the title says in which keys of the scenario they differ.
    """
    require(DRAWING)
    picture_place(out)
    save(draw_runs([open_run(directory) for directory in runs], width), out)
    print(out)
