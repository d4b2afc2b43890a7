"""Python's collector of reference cycles, kept from pausing a loop for milliseconds."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def short_pauses() -> Iterator[None]:
    """What is there at the start is not looked through again: it is all in use until the end."""
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
