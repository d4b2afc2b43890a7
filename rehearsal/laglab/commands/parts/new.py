"""``laglab new``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.check import Kind
from laglab.new import make_package


def new(
    kind: Annotated[Kind, typer.Argument(help="What it is to be.")],
    name: Annotated[str, typer.Argument(metavar="NAME", help="The package's and its own.")],
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="The folder in which its own is made.")
    ] = Path(),
) -> None:
    """Make a small package for a filter, law or plant.

    A module, an entry point by which laglab finds it, and a test that runs `laglab check`.
    """
    made = make_package(kind, name, out)
    print(f"made {made.folder}; and now:")
    for command in made.commands:
        print(f"    {command}")
