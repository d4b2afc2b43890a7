"""The station's answer to a tick, put together from its messages."""

from collections import deque
from collections.abc import Iterable
from typing import NamedTuple

from laglab_protocol import UNANNOUNCED, Command, Estimate, Plan, Recall, frames_of


class Said(NamedTuple):
    """A command, and what goes with it."""

    command: Command
    beside: list[Recall | Plan]


class Answer:
    """Gathers the answer to the robot's tick, and takes late commands for earlier ticks."""

    def __init__(self) -> None:
        self.through = -1
        """The tick of the last command that was taken."""
        self.command: Command | None = None
        self.estimates: deque[Estimate] = deque(maxlen=UNANNOUNCED)
        self._beside = _kept()

    def begin(self) -> None:
        """Nothing was said yet at this tick, but of a plan whose command is still on its way: on a
        slow line they come one after the other."""
        self.command = None
        self.estimates.clear()
        if self._beside:
            self._beside = _kept(each for each in self._beside if isinstance(each, Plan))

    def take(self, message: Estimate | Recall | Plan | Command, tick: int) -> Said | None:
        """What goes on the link at `tick` now that `message` has come: a whole command for this
        tick, or one for an earlier tick, however late; None when there is none."""
        match message:
            case Recall() | Plan():
                self._beside.append(message)
            case Estimate() if message.tick == tick and self.command is None:
                self.estimates.append(message)
            case Command() if message.tick == tick and self.command is None:
                if self._is_whole(message):
                    self.command = message
                    return self._said(message)
                self.estimates.clear()  # a frame was lost: the repeat will bring it whole
                self._beside.clear()
            case Command() if self.through < message.tick < tick:
                return self._said(message)
            case Command():  # said again, or for a later tick: what came before it is void too
                self._beside.clear()
        return None

    def _is_whole(self, command: Command) -> bool:
        """Whether all that was said before `command` is here."""
        if not self._beside:
            return len(self.estimates) >= command.estimates and not command.plan
        plans = [each for each in self._beside if isinstance(each, Plan)]
        said = len(self.estimates) + len(self._beside) - len(plans)
        its_own = sum(plan.tick == command.tick for plan in plans)
        return said >= command.estimates and its_own >= frames_of(command)

    def _said(self, command: Command) -> Said:
        self.through = command.tick
        said = Said(command, list(self._beside))
        self._beside.clear()
        return said


def _kept(some: Iterable[Recall | Plan] = ()) -> deque[Recall | Plan]:
    return deque(some, maxlen=UNANNOUNCED)
