"""Of which ticks measurements have come: a repeat is to be known as one."""

from typing import NamedTuple

from laglab_control.past.memory import MEMORY

ALL = (1 << MEMORY) - 1


class Seen(NamedTuple):
    """A set of ticks; immutable."""

    newest: int = -1
    ticks: int = 0
    """Bit i: whether `newest` - i is in it."""

    def __contains__(self, tick: object) -> bool:
        """Whether one of that tick came, or it is too old to tell."""
        age = self.newest - tick if isinstance(tick, int) else MEMORY
        return age >= MEMORY or (age >= 0 and bool(self.ticks >> age & 1))

    def and_of(self, tick: int) -> "Seen":
        """With that one too."""
        newer = tick - self.newest
        if newer > 0:
            return Seen(tick, (self.ticks << newer | 1) & ALL)
        return Seen(self.newest, self.ticks | 1 << -newer)
