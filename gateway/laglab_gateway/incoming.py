"""The robot's end of the way of commands: what has come across the link, and what is to be done."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from laglab_gateway.link.channel import Channel
from laglab_gateway.link.log import LinkRow
from laglab_gateway.plans import Assembly, Planned
from laglab_protocol import Command, Plan, Playout, Recall


class Came(NamedTuple):
    """What there is at a tick."""

    commands: list[Command]
    """Out of the link, whatever becomes of them."""
    ready: list[Planned]
    """To be followed from this tick on."""
    late: list[Planned]
    """Too late for play-out."""
    incomplete: list[Command]
    """Of which a part of the plan never came."""
    recalls: list[Recall]


class Incoming:
    """The channel, the parts of plans put together, and play-out. Ticks are those of the stamps;
    the channel's are counted from the run's `first`."""

    def __init__(self, channel: Channel[Command | Plan | Recall], playout: int) -> None:
        self.first = 0
        self._channel = channel
        self._assembly = Assembly()
        self._playout = Playout[Planned](playout) if playout else None

    def push(
        self, elapsed: int, command: Command, plans: Iterable[Plan], recalls: Iterable[Recall]
    ) -> None:
        """Put a command on the link, with all that goes with it."""
        playout = self._playout
        until = command.tick - self.first + playout.bound if playout else math.inf
        self._channel.push(elapsed, command, until)
        for recall in recalls:
            self._channel.push(elapsed, recall)
        for plan in plans:
            self._channel.push(elapsed, plan, until)

    def take(self, tick: int) -> Came:
        """What has come by `tick`."""
        came = Came([], [], [], [], [])
        for message, _ in self._channel.due(tick - self.first):
            match message:
                case Recall():
                    came.recalls.append(message)
                case Command(plan=0):
                    came.commands.append(message)
                    came.ready.append(Planned(message))
                case _:
                    self._put_together(message, came)
        return came if self._playout is None else self._played_out(self._playout, tick, came)

    def _put_together(self, message: Command | Plan, came: Came) -> None:
        if isinstance(message, Command):
            came.commands.append(message)
        if whole := self._assembly.take(message):
            came.ready.append(whole)
        came.incomplete.extend(self._assembly.take_given_up())

    def _played_out(self, playout: Playout[Planned], tick: int, came: Came) -> Came:
        late = playout.take(tick, came.ready)
        return came._replace(late=late, ready=playout.due(tick))

    def clear(self) -> None:
        """Lose all that is on its way, or waits."""
        self._channel.clear()
        self._assembly = Assembly()
        if self._playout:
            self._playout.clear()

    def take_log(self) -> list[LinkRow]:
        """The channel's."""
        return self._channel.take_log()
