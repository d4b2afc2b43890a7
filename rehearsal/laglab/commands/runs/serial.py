"""``laglab serial``."""

from pathlib import Path
from typing import Annotated

import typer

from laglab.tables import say
from laglab_protocol import SerialPair


def serial(
    path_1: Annotated[Path, typer.Argument(metavar="PATH1", help="Where one port appears.")],
    path_2: Annotated[Path, typer.Argument(metavar="PATH2", help="Where the other appears.")],
    baud: Annotated[
        int, typer.Option(min=50, max=4_000_000, help="Bits per second, ten to a byte.")
    ] = 57600,
) -> None:
    """Make two serial ports joined by a cable, until Ctrl-C."""
    with SerialPair(str(path_1), str(path_2), baud) as pair:
        say(f"{path_1} and {path_2} are joined at {baud} baud; Ctrl-C ends it")
        try:
            pair.carry()
        finally:
            for way, names in zip(pair.lanes, ((path_1, path_2), (path_2, path_1)), strict=True):
                print(_report(*names, way.carried, way.overrun))


def _report(source: Path, destination: Path, carried: int, overrun: int) -> str:
    lost = f", {overrun} lost because nobody read them" if overrun else ""
    return f"{source} to {destination}: {carried} bytes{lost}"
