"""Small robots with a clock of their own, each with one fault, or one habit, if told so."""

import math
import struct
import time
from collections import deque

from laglab_protocol import NO_COMMAND, Command

from .reference_robots import Robot

PERIOD = 0.01
LINK_TIMEOUT, RAMP = 0.5, 0.2
BURST = 20
LATE = 0.15


class FreeRunningRobot(Robot):
    """Ticks by its own clock, and follows the newest command."""

    due = 0.0

    def wait(self) -> None:
        super().wait()
        self.followed = NO_COMMAND
        self.fresh = 0.0
        self.under_way: deque[tuple[float, Command]] = deque()

    def begin(self) -> None:
        self.tick, self.due = 0, time.monotonic()

    def listen(self, seconds: float) -> None:
        waits = self.fault == "waits for its first command" and self.newest == NO_COMMAND
        if self.tick is None or (waits and self.tick > 0):
            super().listen(seconds)
            self.due = time.monotonic()
        elif (left := self.due - time.monotonic()) > 0:
            super().listen(left)
        else:
            self.step(self.tick)

    def step(self, tick: int) -> None:
        while self.under_way and self.under_way[0][0] < time.monotonic():
            self.take(self.under_way.popleft()[1])
        self.say_tick(tick)
        if self.fault == "repeats ticks" and tick % 16 == 0:
            self.say_tick(tick)
        self.followed = self.newest
        if self.fault != "moves by itself":
            self.speed = self.entry(tick) * self.share()
            if self.fault == "counts in single precision":
                (self.speed,) = struct.unpack("f", struct.pack("f", self.speed))
        self.due += self.pause(tick)
        self.tick = tick + (2 if self.fault == "leaves ticks out" and tick % 16 == 0 else 1)

    def share(self) -> float:
        """Of the commanded speed: a ramp to a standstill when nothing newer has come."""
        if self.fault == "does not stop":
            return 1.0
        silent = time.monotonic() - self.fresh
        return min(1.0, max(0.0, 1.0 - (silent - LINK_TIMEOUT) / RAMP))

    def pause(self, tick: int) -> float:
        if self.fault == "tires":
            return float(min(0.005 * 1.01**tick, 0.04))
        if self.fault == "bursts":
            return 0.0 if (tick + 1) % BURST else BURST * PERIOD
        if self.fault == "dozes" and time.monotonic() - self.fresh > LINK_TIMEOUT:
            return 0.4
        return PERIOD

    def silence(self) -> None:
        """It waits for nobody."""

    def in_force(self, _: int) -> int:
        return self.followed

    def hear_command(self, command: Command) -> None:
        if not math.isfinite(command.v):
            self.deaf = 1 if self.fault == "stumbles over NaN" else 0
        elif self.fault == "is late":
            self.under_way.append((time.monotonic() + LATE, command))
        else:
            self.take(command)

    def take(self, command: Command) -> None:
        again = self.fault == "takes the same stamp twice" and command.tick == self.newest
        older = self.fault == "follows older commands" and command.tick < self.newest
        if command.tick > self.newest or again or older:
            before, self.fresh = self.newest, time.monotonic()
            self.follow(command)
            if self.newest == before and not again:
                return
            self.fresh += PERIOD * len(self.planned.following)
