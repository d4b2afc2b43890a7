"""Files that are written whole or not at all."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from laglab.errors import ResultsError


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """A new file to write into; what was not written to the end is removed again.

    Raises: ResultsError.
    """
    try:
        file = path.open("wb")
    except OSError as error:
        raise _cannot_write(path, error) from error
    try:
        with file:
            yield file
    except BaseException as error:
        if path.is_file():
            with suppress(OSError):
                path.unlink()
        if isinstance(error, OSError):
            raise _cannot_write(path, error) from error
        raise


def _cannot_write(path: Path, error: OSError) -> ResultsError:
    return ResultsError(f"cannot write {path}: {error.strerror or error}")
