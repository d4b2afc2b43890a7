"""``laglab compare``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.extras import REHEARSING, require
from laglab.results.figure import draw_side_by_side, save
from laglab.run.rehearse import SCENARIO_FILE
from laglab.scenario import load
from laglab_gateway import TRACE_FILE, read_trace


def compare(
    runs: Annotated[list[Path], typer.Argument(metavar="DIR...", help="What runs left.")],
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The picture, a PNG.")] = Path(
        "compare.png"
    ),
) -> None:
    """Draw several runs in one picture, a row each."""
    require(REHEARSING)
    drawn = [(read_trace(run / TRACE_FILE), load(str(run / SCENARIO_FILE))) for run in runs]
    save(draw_side_by_side(drawn), out)
    print(out)
