"""Files that are written whole or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from laglab.errors import ResultsError


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """To write into; it takes the place of what was there when all is written, and not before.

    Raises: ResultsError.
    """
    beside = path.with_name(f".{os.getpid()}.new") if path.is_file() or not path.exists() else path
    try:
        with beside.open("wb") as file:
            yield file
        if beside is not path:
            beside.replace(path)
    except BaseException as error:
        if beside is not path:
            with suppress(OSError):
                beside.unlink(missing_ok=True)
        if isinstance(error, OSError):
            problem = error.strerror or error
            raise ResultsError(f"cannot write {path}: {problem}") from error
        raise
