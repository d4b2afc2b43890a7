"""Where somebody wants results: what cannot be is found before anything runs."""

import tempfile
from pathlib import Path

from laglab.errors import PlaceError


def folder_place(named: str, path: Path) -> Path:
    """The folder, made where it is not there; files can be made in it. Raises PlaceError.

    `named` is how the command line calls it.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=path).close()
    except (FileExistsError, NotADirectoryError):
        raise PlaceError(f"{named} {path}: that is a file: results go into a folder") from None
    except OSError as error:
        raise PlaceError(f"{named} {path}: cannot write there: {error.strerror}") from error
    return path


def file_place(named: str, path: Path) -> Path:
    """The file, which can be written; what it holds is still there. Raises PlaceError."""
    try:
        there = path.exists() or path.is_symlink()
        if path.is_dir():
            raise PlaceError(f"{named} {path}: that is a folder: name a file")
        if path.is_file() or not there:  # to open a pipe has consequences
            path.open("ab").close()
        if not there:
            path.unlink()
    except OSError as error:
        raise PlaceError(f"{named} {path}: cannot write there: {error.strerror}") from error
    return path
