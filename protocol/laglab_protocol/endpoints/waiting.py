"""Waiting for a descriptor, exact to well below a millisecond."""

import select


def readable(descriptor: int, timeout: float) -> bool:
    """Whether there is something to read within `timeout` seconds."""
    return bool(select.select([descriptor], [], [], max(timeout, 0.0))[0])


def writable(descriptor: int, timeout: float) -> bool:
    """Whether there is room to write within `timeout` seconds."""
    return bool(select.select([], [descriptor], [], max(timeout, 0.0))[1])
