"""``laglab map``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.commands.options import PictureOption
from laglab.extras import MAPPING, require
from laglab.results.figures import picture_place, save
from laglab.studies.maps import draw_study, read_runs


def map_study(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="What a study left.")],
    x: Annotated[str | None, typer.Option(metavar="KEY", help="Of the grid, to the right.")] = None,
    y: Annotated[str | None, typer.Option(metavar="KEY", help="Of the grid, upwards.")] = None,
    panels: Annotated[
        str | None, typer.Option(metavar="KEY", help="Of the grid, a panel or line for each value.")
    ] = None,
    value: Annotated[
        list[str] | None,
        typer.Option(
            metavar="COLUMN",
            help="What is drawn; may be repeated. converged, rms_x and others by default.",
        ),
    ] = None,
    out: PictureOption = Path("map.png"),
) -> None:
    """Draw a study's results again, without running it.

    The two keys with the most values span the map, the next one makes panels side by side.
    """
    require(MAPPING)
    picture_place(out)
    save(draw_study(read_runs(folder), value or (), x, y, panels), out)
    print(out)
