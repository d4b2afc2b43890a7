"""Figures as files."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from laglab.errors import LaglabError, PlaceError, UndrawableError
from laglab.files import file_place, whole_file
from laglab.results.figures.style import printed, sheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIGURE_FILE = "figure.png"
DOTS_PER_INCH = 220


def save(figure: Figure, path: Path) -> None:
    """Write the figure as the name's ending says. Raises ResultsError, UndrawableError."""
    try:
        with printed(), whole_file(path) as file:
            figure.savefig(file, format=_format(path), dpi=DOTS_PER_INCH)
    except OverflowError as error:
        raise UndrawableError(
            f"{path} cannot be drawn: it shows numbers that are too large; is the run damaged?"
        ) from error


def picture_place(path: Path, named: str = "--out") -> Path:
    """Where the option wants a picture: it can be drawn there. Raises PlaceError."""
    known = sheet(1, 1).canvas.get_supported_filetypes()
    if _format(path) not in known:
        raise PlaceError(f"{named} {path}: its name must end in one of {', '.join(known)}")
    return file_place(named, path)


def _format(path: Path) -> str:
    return path.suffix[1:].lower()


def save_figure(draw_it: Callable[[], Figure], directory: Path) -> None:
    """Draw a run's figure beside its other results, where there is matplotlib.

    Raises: ResultsError, UndrawableError, the latter for whatever else comes in the way.
    """
    if find_spec("matplotlib") is None:
        return
    path = directory / FIGURE_FILE
    try:
        save(draw_it(), path)
    except LaglabError:
        raise
    except Exception as error:  # a library's, fonts', settings': the run is what it is all the same
        said = " ".join(str(error).split()) or type(error).__name__
        raise UndrawableError(f"{path} cannot be drawn: {said}") from error
