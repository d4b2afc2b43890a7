"""What was planned with each command, and what of it the robot is believed to follow."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from laglab_control.laws.interface import STAND, Demand
from laglab_control.model import Vector
from laglab_control.past.log import Log, append, logged
from laglab_control.past.memory import MEMORY


class Plans(NamedTuple):
    """The plans of all commands, each with the command itself as its first entry. Immutable.

    At tick j the robot is in entry j - n - k of the newest plan k that it has. So where commands
    come `behind` ticks later than the n for which they are made, it is in entry `behind` of an
    older plan, and not at the beginning of the one that is meant for j.
    """

    horizon: int
    """H: how many entries follow a command at most."""
    behind: int
    made: Log[tuple[Demand, ...]]

    def send(self, plan: Sequence[Demand]) -> "tuple[Plans, Vector]":
        """With the plan of this tick; the input that is believed to be in force n ticks later."""
        horizon, behind, made = self
        made = append(made, tuple(plan), MEMORY)
        later = Plans(horizon, behind, made)
        if behind >= made.length:
            return later, STAND
        entries = made.items[made.length - 1 - behind]
        v, omega, _ = entries[min(behind, len(entries) - 1)]
        return later, np.array((v, omega))

    def late(self, behind: int) -> "Plans":
        """From now on commands come so many ticks later than they are meant to."""
        return self._replace(behind=behind)


def no_plans(horizon: int) -> Plans:
    """Before the first."""
    return Plans(horizon, 0, logged())
