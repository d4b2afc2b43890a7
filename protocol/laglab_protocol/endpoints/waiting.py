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

    Nothing means that nothing came until then, however late it is when that is found out.
    `descriptor()` is readable when it would give more; asked for before each wait.
    """
    now = monotonic()
    deadline = now + timeout
    until = min(now + POLLED, deadline)
    data = _poll(read, until)
    while data is None and until < deadline:
        left = deadline - monotonic()
        select.select([descriptor()], [], [], min(max(left - POLLED, 0.0), LONGEST))
        until = min(monotonic() + POLLED, deadline)
        data = _poll(read, until)
    return data or b""


def _poll(read: Callable[[], bytes | None], until: float) -> bytes | None:
    """Asked for the last time when it is that late, or later: after the clock, not before."""
    while True:
        last = monotonic() >= until
        if (data := read()) is not None or last:
            return data
        _yield()  # the far end may be waiting for this very processor


def writable(descriptor: int, timeout: float) -> bool:
    """Whether there is room to write within `timeout` seconds."""
    return bool(select.select([], [descriptor], [], min(max(timeout, 0.0), LONGEST))[1])
