"""`laglab fmu`."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from laglab_fmu import PLATFORMS, build_fmus, fmu_path

app = typer.Typer(help="The robot as an FMU.", no_args_is_help=True)


@app.callback()
def fmu() -> None:
    """The robot as an FMU."""


@app.command()
def build(
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Where they go; else where laglab's are."
        ),
    ] = None,
    all_platforms: Annotated[
        bool,
        typer.Option(
            "--all-platforms",
            help="For Linux, Windows and macOS, by ziglang; the first time takes minutes.",
        ),
    ] = False,
) -> None:
    """Build Robot2.fmu, Robot3.fmu and Fleet3.fmu, for this machine or for all."""
    with Console(stderr=True).status("compiling"):
        built = build_fmus(out or fmu_path(3).parent, PLATFORMS if all_platforms else ())
    for path in built:
        print(path)
