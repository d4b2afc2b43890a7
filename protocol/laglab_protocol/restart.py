"""Whether a robot has begun again, or only its old ticks come late."""

BEGUN_AGAIN = "the robot has begun again"
"""Who finds it says so: in the same words, so that nobody is told twice."""

SAME = 4
"""So often in a row no link brings the same old tick by itself: a robot repeats it."""
OLD = 20
"""So many old ticks in a row, in order, no link brings by itself: a robot counts anew."""


class Restart:
    """Watches the ticks of one robot, in the order in which they come."""

    def __init__(self) -> None:
        self._last = -1
        self._same = self._old = 0

    def shows(self, tick: int, newest: int) -> bool:
        """Whether `tick`, which came when `newest` was the newest so far, shows a new beginning."""
        if tick >= newest:
            self._last, self._same, self._old = -1, 0, 0
            return False
        self._same = self._same + 1 if tick == self._last else 1
        self._old = self._old + 1 if tick >= self._last else 1
        self._last = tick
        return self._same >= SAME or self._old >= OLD
