"""`laglab compare`."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.extras import DRAWING, require
from laglab.results.figure import draw_side_by_side, picture_place, save
from laglab.results.run import open_run


def compare(
    runs: Annotated[list[Path], typer.Argument(metavar="DIR...", help="What runs left.")],
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The picture: PNG, PDF, SVG and others.")
    ] = Path("compare.png"),
) -> None:
    """Draw several runs in one picture, a row each."""
    require(DRAWING)
    picture_place(out)
    opened = [open_run(directory) for directory in runs]
    save(draw_side_by_side([(run.drawn, run.scenario, run.alarms) for run in opened]), out)
    print(out)
