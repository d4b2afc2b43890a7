"""``laglab fmu``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab_fmu import build_fmus

app = typer.Typer(help="The robot as an FMU.", no_args_is_help=True)


@app.callback()
def fmu() -> None:
    """The robot as an FMU."""


@app.command()
def build(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where the FMUs go.")] = Path(),
) -> None:
    """Build Robot2.fmu and Robot3.fmu."""
    for path in build_fmus(out):
        print(path)
