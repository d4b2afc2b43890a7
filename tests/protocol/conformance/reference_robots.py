"""Small robots in lock-step that keep the rules, each with one fault if told so."""

import math
import time
from pathlib import Path

from msgspec.structs import replace

from laglab_protocol import (
    NO_COMMAND,
    Applied,
    Assembly,
    AutopilotVersion,
    Command,
    CommandAck,
    CommandLong,
    End,
    Endpoint,
    EndReason,
    Estimate,
    Heartbeat,
    Measurement,
    Message,
    ParamRequestList,
    ParamRequestRead,
    ParamValue,
    Ping,
    Plan,
    Planned,
    Recall,
    Settings,
    Tick,
)

from .peer import ALIVE, Peer

SILENCE = 3.0
BEGINS_ANEW = {"", "never gives up"}
"""These have another run after END: a matter of taste, and a matter of seconds for the kit."""


class Robot(Peer):
    """In lock-step. It stands still, or creeps."""

    def __init__(self, endpoint: Endpoint, fault: str, key_file: Path | None) -> None:
        super().__init__(endpoint, fault, key_file)
        self.begins_anew = fault in BEGINS_ANEW
        self.heard_at = 0.0
        self.wait()

    def wait(self) -> None:
        """For a heartbeat."""
        self.tick: int | None = None
        self.newest = NO_COMMAND
        self.speed = 0.1 if self.fault == "moves by itself" else 0.0
        self.slow_until = 0
        self.estimates = 0
        self.repeats = 0
        self.planned = Planned(Command(0.0, 0.0, NO_COMMAND, 1, 1, 0))
        self.assembly = Assembly()
        self.owed: Applied | None = None
        self.telling: Applied | None = None
        self.told = -1

    def silence(self) -> None:
        if self.tick is None or self.fault == "never repeats":
            return
        if time.monotonic() - self.heard_at > SILENCE and self.fault != "never gives up":
            self.send(End(self.tick, EndReason.FAILED))
            self.wait()
            return
        self.repeats += 1
        self.say_tick(self.tick)

    def begin(self) -> None:
        self.tick = 7 if self.fault == "begins late" else 0
        self.say_tick(self.tick)

    def say_tick(self, tick: int) -> None:
        x = float(self.repeats) if self.fault == "measures again for a repeat" else 0.0
        y = math.inf if self.fault == "measures infinity" else 0.0
        v = -self.speed if self.fault == "tells of motion backwards" else self.speed
        sampled = tick + (self.fault == "measures ahead")
        sample = Measurement(x, y, 0.0, v, 0.0, sampled, self.echo(self.in_force(tick)))
        if tick != self.told:
            self.telling, self.owed, self.told = self.owed, None, tick
        first = [sample] if self.telling is None else [self.telling, sample]
        first = [] if self.fault == "measures nothing" else first
        said = Tick(tick, len(first) + (self.fault == "miscounts measurements"))
        self.send(*([said, *first] if self.fault == "says the tick first" else [*first, said]))

    def echo(self, stamp: int) -> int:
        if self.fault == "echoes the stamp before":
            return max(stamp - 1, NO_COMMAND)
        late = self.fault == "echoes the stamp after" and stamp != NO_COMMAND
        return stamp + 1 if late else stamp

    def in_force(self, tick: int) -> int:
        """The stamp of the command in force before this tick."""
        stands = self.speed == 0.0
        late = self.fault == "goes back to earlier commands" and tick % 5 == 0 and stands
        return max(self.newest - 2 * late, NO_COMMAND)

    def hear(self, message: Message) -> None:
        self.heard_at = time.monotonic()
        match message:
            case Heartbeat() if self.tick is None:
                self.begin()
            case Plan():
                self.hear_plan(message)
            case Estimate() | Recall():
                self.estimates += 1
                self.serve(message)
            case Command() if self.is_meant(message):
                self.hear_command(message)
            case End() if self.fault != "ignores END":
                self.hear_end(message)
            case _:
                self.serve(message)

    def hear_end(self, message: End) -> None:
        reason = 3 if self.fault == "gives another reason" else message.reason
        tick = 0 if self.fault == "ends at tick 0" else self.tick or 0
        self.send(*[End(tick, reason)] * (2 if self.fault == "says END twice" else 1))
        if self.fault == "goes on after END":
            return
        if self.fault == "ticks once after END":
            self.say_tick(self.tick or 0)
        self.wait()
        if not self.begins_anew:
            self.left.set()

    def is_meant(self, command: Command) -> bool:
        target = command.target_system, command.target_component
        if self.fault in ("takes target 0", "takes any target"):
            return (target[0] == 0) == (self.fault == "takes target 0") or target[0] == self.system
        return target == (self.system, self.component)

    def hear_command(self, command: Command) -> None:
        if self.tick is None:
            return
        ticks = {
            "takes later commands": (0, 1),
            "takes earlier commands": (0, -1),
        }.get(self.fault, (0,))
        if command.v != command.v:
            self.slow_until = self.tick + 9 if self.fault == "is slow" else 0
            self.deaf = 1 if self.fault == "stumbles over NaN" else 0
            return
        whole = self.estimates >= command.estimates or self.fault == "does not wait for estimates"
        if command.tick - self.tick in ticks and whole:
            self.estimates = 0
            self.slow = self.tick < self.slow_until
            self.follow(command)
            self.newest = min(self.newest, self.tick)
            self.speed = 0.1 if self.fault == "moves by itself" else self.entry(self.tick)
            self.tick += 2 if self.fault == "leaves ticks out" and self.tick > 12 else 1
            self.say_tick(self.tick)

    def hear_plan(self, plan: Plan) -> None:
        if self.fault != "has no plans":
            self.assembly.take(plan)

    def follow(self, command: Command) -> None:
        """Unless it lacks a part of its plan, or is meant for later."""
        assert self.tick is not None
        alone = self.fault in ("has no plans", "follows plans in part")
        plain = Planned(replace(command, plan=0))
        whole = plain if self.fault == "has no plans" else self.assembly.take(command)
        whole = whole or (plain if alone else None)
        if whole and (whole.in_force or 0) <= self.tick:
            self.newest, self.planned = command.tick, whole

    def entry(self, tick: int) -> float:
        """Of the newest plan, at this tick."""
        command, first, following = self.planned
        ahead = 0 if first is None else min(tick - first, len(following))
        return following[ahead - 1][0] if ahead > 0 else command.v

    def serve(self, message: Message) -> None:
        number = 1 if self.fault == "loses parameters" else 2
        values = [ParamValue(float(i), 2, i, b"P%d" % i, 9) for i in range(2)]
        match message:
            case CommandLong():
                self.send(*self.acknowledge(message))
            case ParamRequestList():
                self.send(*values[:number])
            case ParamRequestRead(index, _, _, name):
                self.send(values[0 if index == 0 or self.fault != "mixes names up" else 1])
                del name
            case Recall() if self.fault != "forgets":
                v = self.speed + (self.fault == "recalls amiss")
                self.owed = Applied((v,) + (0.0,) * 11, (0.0,) * 12, message.first, 1)
            case Settings() if self.fault != "keeps its settings to itself":
                self.send(self.settings())
            case Ping() if self.fault != "does not answer pings":
                self.send(replace(message, target_system=200, target_component=190))

    def acknowledge(self, message: CommandLong) -> list[Message]:
        if message.command != 512:
            result = 0 if self.fault == "accepts any command" else 3
            target = (7, 190) if self.fault == "acknowledges to another system" else self.master
            return [CommandAck(message.command, result, 0, 0, *target)]
        reports: dict[int, Message] = {
            0: ALIVE,
            148: AutopilotVersion(0, 0, 1, 0, 0, 0, 0, 0, (0,) * 8, (0,) * 8, (0,) * 8),
        }
        told = self.fault != f"does not report {int(message.param1)}"
        return [CommandAck(512, 0), *([reports[int(message.param1)]] if told else [])]
