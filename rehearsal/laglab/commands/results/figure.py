"""`laglab figure`."""

from pathlib import Path

from laglab.commands.options import PictureOption, RunArgument, WidthOption
from laglab.extras import DRAWING, require
from laglab.results.figures import picture_place, save
from laglab.results.run import open_run


def figure(
    run: RunArgument,
    out: PictureOption = Path("figure.pdf"),
    width: WidthOption = "two",
) -> None:
    """Draw what a run left, once more.

    Fit for print; the name's ending says the format.
    """
    require(DRAWING)
    picture_place(out)
    save(open_run(run).figure(width), out)
    print(out)
