"""Python's collector of reference cycles, kept from pausing a loop for milliseconds."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

NEW_OBJECTS = 20_000
"""Looked through at a time, which takes half a millisecond; the loop's own make no cycles."""


@contextmanager
def short_pauses() -> Iterator[None]:
    """For a process that runs one loop: what is there at its start is not looked through again."""
    usual = gc.get_threshold()
    gc.freeze()
    gc.set_threshold(NEW_OBJECTS, *usual[1:])
    try:
        yield
    finally:
        gc.set_threshold(*usual)
        gc.unfreeze()
