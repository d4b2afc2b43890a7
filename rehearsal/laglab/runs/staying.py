"""The folder that the user stands in, whatever somebody's code does."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def staying() -> Iterator[None]:
    """Who wraps a solver may go to a folder of its own and stay there: we go back, for the user's
    relative names mean what they meant."""
    try:
        here = Path.cwd()
    except FileNotFoundError:  # it is gone: there is nowhere to go back to
        yield
        return
    try:
        yield
    finally:
        if Path.cwd() != here:
            os.chdir(here)
