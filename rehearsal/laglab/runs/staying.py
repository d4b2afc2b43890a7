"""The folder that the user stands in, whatever somebody's code does."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def staying() -> Iterator[None]:
    """Who wraps a solver may go to a folder of its own, and stay there or take it away: we go back,
    for the user's relative names mean what they meant."""
    try:
        here = Path.cwd()
    except OSError:  # it is gone: there is nowhere to go back to
        yield
        return
    try:
        yield
    finally:
        with suppress(OSError):
            os.chdir(here)
