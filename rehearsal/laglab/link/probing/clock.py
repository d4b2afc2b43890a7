"""The clock that probes are stamped by."""

import time


class WallClock:
    """The time of day [ns] when it was made, and on from there without a jump."""

    def __init__(self) -> None:
        self._ahead = time.time_ns() - time.monotonic_ns()

    def __call__(self) -> int:
        return self._ahead + time.monotonic_ns()
