"""`laglab figure`."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.extras import DRAWING, require
from laglab.results.figures import Width, picture_place, save
from laglab.results.run import open_run

WidthOption = Annotated[
    Width,
    typer.Option(help="As wide as one column of a journal's page (3.3 in) or as two (7 in)."),
]


def figure(
    run: Annotated[Path, typer.Argument(metavar="DIR", help="What a run left.")],
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE", help="The picture: PNG, PDF, SVG and others.")
    ] = Path("figure.pdf"),
    width: WidthOption = "two",
) -> None:
    """Draw what a run left, once more.

    Fit for print; the name's ending says the format.
    """
    require(DRAWING)
    picture_place(out)
    save(open_run(run).figure(width), out)
    print(out)
