"""Waiting for a descriptor, exact to well below a millisecond."""

import select
from time import monotonic

POLLED = 3e-4
"""[s] A sleeper is woken a tenth of a millisecond late or more, so the end of a wait is polled."""


def readable(descriptor: int, timeout: float) -> bool:
    """Whether there is something to read within `timeout` seconds."""
    deadline = monotonic() + timeout
    ready = bool(select.select([descriptor], [], [], max(timeout - POLLED, 0.0))[0])
    while not ready and monotonic() < deadline:
        ready = bool(select.select([descriptor], [], [], 0.0)[0])
    return ready


def writable(descriptor: int, timeout: float) -> bool:
    """Whether there is room to write within `timeout` seconds."""
    return bool(select.select([], [descriptor], [], max(timeout, 0.0))[1])
