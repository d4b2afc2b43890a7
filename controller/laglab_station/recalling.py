"""Asking the robot what it did while nobody heard it."""

from typing import NamedTuple

from laglab_control import Told
from laglab_protocol import Recall

PATIENCE = 5
"""Ticks by which a measurement may lag behind later ones before what it tells is asked for."""
AGAIN = 12
"""Ticks after which a question that was not answered yet is asked again: it may be lost."""


class Asked(NamedTuple):
    """What was asked for so far."""

    through: int = -1
    """The newest tick asked for."""
    again: int = 0
    """At this tick the oldest that is still missing is asked for again."""


class Question(NamedTuple):
    """The ticks from `first` on."""

    first: int
    ticks: int


def question(asked: Asked, told: Told, tick: int) -> tuple[Asked, Question | None]:
    """What to ask at `tick`; None: nothing."""
    missing = [each for each in told.missing if each <= told.known - PATIENCE]
    again = tick + AGAIN
    if asked.again > tick:  # some of it is on its way: ask for the rest alone
        missing, again = [each for each in missing if each > asked.through], asked.again
    if not missing:
        return asked, None
    asked = Asked(max(asked.through, missing[-1]), again)
    return asked, Question(missing[0], missing[-1] - missing[0] + 1)


class Questions:
    """What one robot is asked, one question after the other."""

    def __init__(self) -> None:
        self._asked = Asked()

    def ask(self, told: Told, first: int, tick: int, robot: tuple[int, int]) -> list[Recall]:
        """What to say at `tick`; the controller counts its ticks from `first` on."""
        if not told.missing:
            return []
        self._asked, asks = question(self._asked, told, tick - first)
        return [Recall(first + asks.first, asks.ticks, *robot)] if asks else []
