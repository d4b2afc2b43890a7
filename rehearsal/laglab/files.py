"""Files that we write: where somebody wants them, and whole or not at all."""

import os
import secrets
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

import msgspec

from laglab.errors import PlaceError, ResultsError

BESIDE = ".*.new"
"""Pattern of the names of files that are being written; they stay when we are killed meanwhile."""


def here() -> Path:
    """The current directory. Raises PlaceError when somebody has deleted it."""
    try:
        return Path.cwd()
    except FileNotFoundError as error:
        raise PlaceError("the current directory is gone: go to one that is there") from error


def folder_place(named: str, path: Path) -> Path:
    """The folder, made where it is not there; files can be made in it. Raises PlaceError.

    `named` is how the command line calls it.
    """
    _refuse_nowhere(named, path)
    new = [each for each in (path, *path.parents) if not os.path.lexists(each)]
    try:
        path.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=path).close()
    except (FileExistsError, NotADirectoryError):
        raise PlaceError(f"{named} {path}: that is a file: results go into a folder") from None
    except OSError as error:
        for each in new:  # those above it that could be made
            with suppress(OSError):
                each.rmdir()
        raise PlaceError(f"{named} {path}: cannot write there: {error.strerror}") from error
    return path


def file_place(named: str, path: Path, read: Path | None = None) -> Path:
    """The file, which can be written; what it holds is still there. Raises PlaceError.

    `read`: what is written is made of that one, so it is another.
    """
    _refuse_nowhere(named, path)
    try:
        there = path.exists() or path.is_symlink()
        if path.is_dir():
            raise PlaceError(f"{named} {path}: that is a folder: name a file")
        if read and path.is_file() and read.exists() and path.samefile(read):
            raise PlaceError(f"{named} {path}: that is the file to be read: name another")
        if path.is_file() or not there:  # to open a pipe has consequences
            path.open("ab").close()
        if not there:
            path.unlink()
    except OSError as error:
        raise PlaceError(f"{named} {path}: cannot write there: {error.strerror}") from error
    return path


def _refuse_nowhere(named: str, path: Path) -> None:
    """Nothing is in a folder that is gone; no file can have NUL in its name, and nobody can write
    down one that is not UTF-8."""
    if not path.is_absolute():
        here()
    try:
        nameless = b"\0" in str(path).encode()
    except UnicodeEncodeError:
        nameless = True
    if nameless:
        raise PlaceError(f"{named} {str(path)!r}: that is no name in UTF-8: give it another")


@contextmanager
def whole_file(path: Path, lasting: bool = False) -> Iterator[BinaryIO]:
    """To write into; it takes the place of what was there when all is written, and not before.

    `lasting`: even when the machine then loses its power. Raises: ResultsError.
    """
    own = f".{os.getpid()}-{secrets.token_hex(4)}.new"
    beside = path.with_name(own) if path.is_file() or not path.exists() else path
    try:
        with beside.open("wb") as file:
            yield file
            if lasting:
                file.flush()
                os.fsync(file.fileno())
        if beside is not path:
            beside.replace(path)
            if lasting:
                _sync_folder(path.parent)
    except BaseException as error:
        if beside is not path:
            with suppress(OSError):
                beside.unlink(missing_ok=True)
        if isinstance(error, OSError):
            problem = error.strerror or error
            raise ResultsError(f"cannot write {path}: {problem}") from error
        raise


def write_whole(path: Path, content: str | bytes, lasting: bool = False) -> None:
    """All of it at once. Raises: ResultsError."""
    with whole_file(path, lasting) as file:
        file.write(content.encode() if isinstance(content, str) else content)


def json_of(value: object) -> str:
    """As JSON, indented, for people to read too."""
    return msgspec.json.format(msgspec.json.encode(value), indent=2).decode() + "\n"


def _sync_folder(folder: Path) -> None:
    """So that the name lasts, too; not every system has it for folders."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
