"""How much of what strangers ask for is done: so much a second, so much at once."""

LEAST_BYTES = 64
"""For rations of bytes: a piece costs as much as that, however short it is."""


class Ration:
    """Fills up with time, and holds no more than `at_once`. No clock of its own.

    What is taken may be more than is left, where its size is only known afterwards: then nothing
    is left until that is made up for.
    """

    def __init__(self, per_second: float, at_once: float, least: float = 0.0) -> None:
        """`least`: whatever is done costs as much as that."""
        self._per_second = per_second
        self._at_once = at_once
        self._least = least
        self.rest = at_once
        """What was left when it was last looked at, less what was taken since."""
        self._filled = float("-inf")

    def left(self, now: float) -> float:
        """What is left at `now` [s], which must not go back; 0 or less: nothing."""
        more = (now - self._filled) * self._per_second
        self.rest = min(self._at_once, self.rest + more)
        self._filled = now
        return self.rest

    def take(self, amount: float) -> None:
        """So much has been done."""
        self.rest -= max(amount, self._least)
