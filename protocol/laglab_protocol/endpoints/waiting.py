"""Waiting for bytes without being late."""

import os
import select
from collections.abc import Callable
from time import monotonic, sleep

POLLED = 5e-4
"""[s] Waking a sleeper takes a tenth of a millisecond, longer than the far end may take to answer:
so the beginning of a wait is polled, and its end, in order to be in time for the deadline."""

LONGEST = 3600.0
"""[s] Systems refuse to sleep for ever; who wakes early sleeps again."""

_yield: Callable[[], None] = getattr(os, "sched_yield", lambda: sleep(0.0))


def first_bytes(
    read: Callable[[], bytes | None], descriptor: Callable[[], int], timeout: float
) -> bytes:
    """What `read` gives within `timeout` seconds, asked once at least; it gives None for not yet.

    `descriptor()` is readable when it would give more; asked for before each wait.
    """
    now = monotonic()
    deadline = now + timeout
    data = _poll(read, min(now + POLLED, deadline))
    while data is None and (left := deadline - monotonic()) > 0:
        select.select([descriptor()], [], [], min(max(left - POLLED, 0.0), LONGEST))
        data = _poll(read, min(monotonic() + POLLED, deadline))
    return data or b""


def _poll(read: Callable[[], bytes | None], until: float) -> bytes | None:
    while (data := read()) is None and monotonic() < until:
        _yield()  # the far end may be waiting for this very processor
    return data


def writable(descriptor: int, timeout: float) -> bool:
    """Whether there is room to write within `timeout` seconds."""
    return bool(select.select([], [descriptor], [], min(max(timeout, 0.0), LONGEST))[1])
