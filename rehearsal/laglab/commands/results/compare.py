"""`laglab compare`."""

from pathlib import Path

from laglab.commands.options import PictureOption, RunsArgument, WidthOption
from laglab.extras import DRAWING, require
from laglab.results.figures import draw_runs, picture_place, save
from laglab.results.run import open_run


def compare(
    runs: RunsArgument,
    out: PictureOption = Path("compare.png"),
    width: WidthOption = "two",
) -> None:
    """Lay several runs over each other in one picture.

    On equal axes; the title says in which keys of the scenario they differ.
    """
    require(DRAWING)
    picture_place(out)
    save(draw_runs([open_run(directory) for directory in runs], width), out)
    print(out)
