"""Files that are written whole or not at all."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from laglab.errors import ResultsError

BESIDE = ".*.new"
"""What is there of a file while it is being written; stays when we are killed at that."""


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


def _sync_folder(folder: Path) -> None:
    """So that the name lasts, too; not every system has it for folders."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
