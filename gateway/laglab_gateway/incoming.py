"""The robot's end of the way of commands: what has come across the link, and what is to be done."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from laglab_gateway.link.channel import Channel
from laglab_gateway.link.log import LinkRow
from laglab_protocol import Assembly, Command, Plan, Planned, Playout, Recall

MOST_EARLY = 1024
"""Commands that are meant for later than they come: so many are kept."""


class Came(NamedTuple):
    """What there is at a tick."""

    commands: list[Command]
    """Out of the link, whatever becomes of them."""
    ready: list[Planned]
    """To be followed from this tick on."""
    late: list[Planned]
    """Too late for play-out."""
    incomplete: list[Command]
    """Commands with a plan of which a part never came."""
    recalls: list[Recall]


class Incoming:
    """The channel, plans put together from their parts, and play-out. Ticks are the robot's, as in
    stamps; `elapsed` and the channel's ticks are counted from the run's `first`."""

    def __init__(self, channel: Channel[Command | Plan | Recall], playout: int) -> None:
        self.first = 0
        self._channel = channel
        self._assembly = Assembly()
        self._playout = Playout[Planned](playout) if playout else None
        self._early: list[Planned] = []
        """Meant for later than when they came."""

    def push(self, elapsed: int, command: Command, beside: Iterable[Recall | Plan]) -> None:
        """Put a command on the link with what goes with it, but not with another command's plan."""
        playout = self._playout
        until = command.tick - self.first + playout.bound if playout else math.inf
        self._channel.push(elapsed, command, until)
        for message in beside:
            if isinstance(message, Recall):
                self._channel.push(elapsed, message)
            elif message.tick == command.tick:
                self._channel.push(elapsed, message, until)

    def take(self, tick: int) -> Came:
        """What has come by `tick`."""
        came = Came([], [], [], [], [])
        for message in self._channel.due(tick - self.first):
            match message:
                case Recall():
                    came.recalls.append(message)
                case Command(plan=0):
                    came.commands.append(message)
                    came.ready.append(Planned(message))
                case _:
                    self._put_together(message, came)
        if self._playout:
            late = self._playout.take(tick, came.ready)
            came = came._replace(late=late, ready=self._playout.due(tick))
        return came if not self._early and _are_due(came.ready, tick) else self._held(came, tick)

    def _put_together(self, message: Command | Plan, came: Came) -> None:
        if isinstance(message, Command):
            came.commands.append(message)
        if whole := self._assembly.take(message):
            came.ready.append(whole)
        came.incomplete.extend(self._assembly.take_given_up())

    def _held(self, came: Came, tick: int) -> Came:
        """What is meant for later waits for its time."""
        waiting = sorted(self._early + came.ready, key=lambda each: each.tick)
        self._early = [each for each in waiting if not _is_due(each, tick)][-MOST_EARLY:]
        return came._replace(ready=[each for each in waiting if _is_due(each, tick)])

    def clear(self) -> None:
        """Lose all that is on its way, or waits."""
        self._channel.clear()
        self._assembly = Assembly()
        self._early.clear()
        if self._playout:
            self._playout.clear()

    def take_log(self) -> list[LinkRow]:
        """What the link did to every frame since the last call."""
        return self._channel.take_log()


def _is_due(planned: Planned, tick: int) -> bool:
    return planned.in_force is None or planned.in_force <= tick


def _are_due(planned: Iterable[Planned], tick: int) -> bool:
    return all(_is_due(each, tick) for each in planned)
