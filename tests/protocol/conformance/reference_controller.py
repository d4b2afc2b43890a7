"""A small controller that keeps the rules, with one fault if told so."""

from pathlib import Path

from msgspec.structs import replace

from laglab_protocol import (
    Command,
    End,
    Endpoint,
    Estimate,
    Measurement,
    Message,
    Plan,
    Planned,
    Recall,
    Tick,
)

from .peer import ALIVE, Peer

PLAN = 20
"""Ticks, in two frames."""


class Controller(Peer):
    """Commands standstill."""

    system, component = 200, 190
    master = (1, 1)

    def __init__(self, endpoint: Endpoint, fault: str, key_file: Path | None) -> None:
        super().__init__(endpoint, fault, key_file)
        self.last: int | None = None
        self.newest: int | None = None
        self.missed = False
        self.measurements = 0
        self.again = 0

    def silence(self) -> None:
        if self.last is None:
            secret = self.fault == "keeps its settings to itself"
            self.send(ALIVE, *([] if secret else [self.settings()]))

    def hear(self, message: Message) -> None:
        match message:
            case Measurement():
                self.measurements += 1
                self.missed |= self.newest is not None and message.tick > self.newest + 1
                self.newest = message.tick
            case Tick():
                self.hear_tick(message)
            case End() if self.fault != "ignores END":
                reason = 3 if self.fault == "gives another reason" else message.reason
                times = 2 if self.fault == "says END twice" else 1
                self.send(*[replace(message, reason=reason)] * times)
                if self.fault == "commands after END":
                    self.answer(message.tick)
                self.left.set()

    def hear_tick(self, message: Tick) -> None:
        complete = self.measurements == message.measurements
        self.measurements = 0
        if not complete and self.fault != "does not count measurements":
            return
        newest = self.last is None or message.tick > self.last
        if not newest and message.tick != self.last and self.fault != "goes back in time":
            return
        self.again = 0 if newest else self.again + 1
        self.last = message.tick
        self.answer(message.tick)

    def answer(self, tick: int) -> None:
        self.slow = self.fault == "is slow" and tick > 28
        v = float(self.again) if self.fault == "answers a repeat anew" else 0.0
        if self.fault == "commands infinity":
            v = float("inf")
        stamp = tick + 1 if self.fault == "stamps estimates wrong" else tick
        target = 2 if self.fault == "aims elsewhere" else 1
        estimate: Message = Estimate(*[0.0] * 9, tick=stamp)  # type: ignore[misc]
        if self.missed and self.fault != "does not ask":
            self.missed, estimate = False, Recall(0, 1, 1, 1)
        plans = self.plan(tick)
        command = Command(v, 0.0, tick, target, 1, 1, PLAN)
        twice = self.fault == "answers twice" and tick > 19
        said = [estimate, *plans, command]
        said = [command, estimate, *plans] if self.fault == "commands first" else said
        self.send(*said, *(said if twice else []))
        if self.fault == "ends by itself" and tick == 20:
            self.send(End(0, 3))

    def plan(self, tick: int) -> list[Plan]:
        """To stand still."""
        first = (float("inf"), 0.0) if self.fault == "plans infinity" else (0.0, 0.0)
        in_force = max(tick - 1, 0) if self.fault == "plans for the past" else tick
        following = (first, *((0.0, 0.0),) * (PLAN - 1))
        frames = Planned(Command(0.0, 0.0, tick, 1, 1, 0, PLAN), in_force, following).frames()
        return frames[1:] if self.fault == "plans in part" else frames
