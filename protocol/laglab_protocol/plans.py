"""Commands that plan ahead: taken apart into frames, and put together again."""

from typing import NamedTuple

from msgspec.structs import astuple

from laglab_protocol.messages.loop import LONGEST_PLAN, PLANNED, Command, Plan

OPEN = 64
"""Ticks by which the rest of a plan may be behind what was stamped later."""

FIRST = range(1, LONGEST_PLAN + 1, PLANNED)
"""The elements that a plan's frames may begin with."""

Speeds = tuple[float, float]
"""v [m/s], omega [rad/s]."""


class Planned(NamedTuple):
    """A command, and the speeds that are to follow it, tick by tick, if nothing newer comes."""

    command: Command
    in_force: int | None = None
    """The tick that the command itself is meant for; None: from when it comes."""
    following: tuple[Speeds, ...] = ()

    @property
    def tick(self) -> int:
        """Its stamp."""
        return self.command.tick

    def frames(self) -> list[Plan]:
        """What goes before the command; nothing where it has no plan."""
        _, _, tick, *target, _, _ = astuple(self.command)
        in_force = tick if self.in_force is None else self.in_force
        plans = []
        for start in range(0, len(self.following), PLANNED):
            piece = self.following[start : start + PLANNED]
            v, omega = zip(*piece, *[(0.0, 0.0)] * (PLANNED - len(piece)), strict=True)
            plans.append(Plan(v, omega, tick, in_force, start + 1, *target))
        return plans


def frames_of(command: Command) -> int:
    """How many LAGLAB_PLAN carry its plan."""
    return -(-command.plan // PLANNED)


class _Open(NamedTuple):
    command: Command | None
    frames: dict[int, Plan]
    """By their first element."""

    def whole(self) -> Planned | None:
        """With all elements 1 ... H of its plan; None as long as one is missing."""
        if self.command is None:
            return None
        length, in_force = self.command.plan, None
        following: list[Speeds] = []
        while len(following) < length:
            frame = self.frames.get(len(following) + 1)
            if frame is None:
                return None
            following += zip(frame.v, frame.omega, strict=True)
            in_force = frame.in_force
        return Planned(self.command, in_force, tuple(following[:length]))


class Assembly:
    """Puts commands together: each comes in several frames, in any order, and some may be lost;
    then nothing of it is followed.

    Later stamps make it give up what is not whole: whoever takes frames sees to it that they grow.
    """

    def __init__(self) -> None:
        self._open: dict[int, _Open] = {}
        """By stamp."""
        self._given_up: list[Command] = []

    def take(self, message: Command | Plan) -> Planned | None:
        """One more frame; the command that is whole with it."""
        tick = message.tick
        command, frames = self._open.get(tick, _Open(None, {}))
        if isinstance(message, Command):
            command = message
        elif message.first in FIRST:
            frames[message.first] = message
        self._open[tick] = _Open(command, frames)
        whole = self._open[tick].whole()
        if whole:
            del self._open[tick]
        self._forget(tick - OPEN)
        return whole

    def take_given_up(self) -> list[Command]:
        """The commands since the last call of whose plans the rest will not come any more."""
        given_up, self._given_up = self._given_up, []
        return given_up

    def _forget(self, through: int) -> None:
        for tick in [each for each in self._open if each <= through]:
            command = self._open.pop(tick).command
            if command is not None:
                self._given_up.append(command)
