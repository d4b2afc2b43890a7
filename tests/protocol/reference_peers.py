"""A small robot and a small controller that keep the rules, each with one fault if told so."""

import math
import threading
import time
from pathlib import Path
from typing import Self

from msgspec.structs import replace

from laglab_conformance.forge import Forged
from laglab_protocol import (
    NO_COMMAND,
    Applied,
    AutopilotVersion,
    Codec,
    Command,
    CommandAck,
    CommandLong,
    End,
    Endpoint,
    Estimate,
    Frame,
    Heartbeat,
    Measurement,
    Message,
    ParamRequestList,
    ParamRequestRead,
    ParamValue,
    Ping,
    Recall,
    Sender,
    Settings,
    Tick,
)

from .faulty_intake import INTAKE

REPEAT_AFTER = 0.03
ALIVE = Heartbeat(0, 10, 0, 0, 4, 3)


class Peer(threading.Thread):
    """Listens until END, or until it is left; `fault` is what it does wrong."""

    system, component = 1, 1
    master = (200, 190)

    def __init__(self, endpoint: Endpoint, fault: str, key_file: Path | None) -> None:
        super().__init__()
        self.endpoint = endpoint
        self.fault = fault
        self.codec = Codec(self.system, self.component, key_file)
        self.open = Codec(self.system, self.component)
        self.left = threading.Event()
        self.deaf = 0
        self.slow = False

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.left.set()
        self.join()
        self.codec.close()

    def run(self) -> None:
        while not self.left.is_set():
            self.listen(REPEAT_AFTER)

    def listen(self, seconds: float) -> None:
        data = self.endpoint.receive(seconds)
        if not data:
            self.silence()
        for frame in self.intake(data):
            self.endpoint.accept_peer()
            if self.obeys(frame):
                self.hear(frame.message)

    def obeys(self, frame: Frame) -> bool:
        if self.fault == "obeys any component":
            return frame.system == self.master[0]
        if self.fault == "obeys anybody":
            return frame.component == self.master[1]
        return (frame.system, frame.component) == self.master

    def silence(self) -> None:
        """Nothing came for a while."""

    def hear(self, message: Message) -> None:
        """A message came from the other side."""

    def intake(self, data: bytes) -> list[Frame]:
        if self.deaf and data:
            self.deaf -= 1
            return []
        data = INTAKE.get(self.fault, lambda _, data: data)(self, data)
        receiver = self.codec.receiver
        if self.fault == "believes the unsigned" and data[:1] == b"\xfd" and not data[2]:
            receiver = self.open.receiver
        return receiver.receive(data, whole=True)

    def send(self, *messages: Message) -> None:
        if self.slow:
            time.sleep(0.3)  # more than the kit allows
        raw = b"".join(self.framed(message) for message in messages)
        self.endpoint.send(raw + (b"?" if self.fault == "sends stray bytes" else b""))
        if self.fault == "signs not all":
            self.endpoint.send(Sender(self.system, self.component).frame(ALIVE))

    def framed(self, message: Message) -> bytes:
        raw = self.codec.sender.frame(message)
        if self.fault == "skips numbers":
            self.codec.sender.frame(message)
        if self.fault == "sends zeros":
            forged = Forged.of(message, self.system, self.component, raw[4], None)
            return forged.untrimmed(message).raw
        return raw


class Robot(Peer):
    """Stands still."""

    def __init__(self, endpoint: Endpoint, fault: str, key_file: Path | None) -> None:
        super().__init__(endpoint, fault, key_file)
        self.tick: int | None = None
        self.slow_until = 0
        self.estimates = 0
        self.repeats = 0
        self.owed: Applied | None = None
        self.telling: Applied | None = None
        self.told = -1
        self.speed = 0.1 if fault == "moves by itself" else 0.0

    def silence(self) -> None:
        if self.tick is not None and self.fault != "never repeats":
            self.repeats += 1
            self.say_tick(self.tick)

    def begin(self) -> None:
        self.tick = 0
        self.say_tick(0)

    def say_tick(self, tick: int) -> None:
        x = float(self.repeats) if self.fault == "measures again for a repeat" else 0.0
        sample = Measurement(x, 0.0, 0.0, self.speed, 0.0, tick, self.in_force(tick))
        if tick != self.told:
            self.telling, self.owed, self.told = self.owed, None, tick
        first = [sample] if self.telling is None else [self.telling, sample]
        wrong = self.fault == "miscounts measurements"
        self.send(*first, Tick(tick, len(first) + wrong))

    def in_force(self, tick: int) -> int:
        """The stamp of the command in force before this tick."""
        late = 2 if self.fault == "goes back to earlier commands" and tick % 5 == 0 else 0
        return max(tick - 1 - late, NO_COMMAND)

    def hear(self, message: Message) -> None:
        match message:
            case Heartbeat() if self.tick is None:
                self.begin()
            case Estimate() | Recall():
                self.estimates += 1
                self.serve(message)
            case Command() if self.is_meant(message):
                self.hear_command(message)
            case End() if self.fault != "ignores END":
                reason = 3 if self.fault == "gives another reason" else message.reason
                self.send(End(self.tick or 0, reason))
                if self.fault != "goes on after END":
                    self.left.set()
            case _:
                self.serve(message)

    def is_meant(self, command: Command) -> bool:
        target = command.target_system, command.target_component
        return target == (self.system, self.component) or self.fault == "takes any target"

    def hear_command(self, command: Command) -> None:
        assert self.tick is not None
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
            self.tick += 2 if self.fault == "leaves ticks out" and self.tick > 12 else 1
            self.say_tick(self.tick)

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
                self.send(Settings(0.01))
            case Ping() if self.fault != "does not answer pings":
                self.send(replace(message, target_system=200, target_component=190))

    def acknowledge(self, message: CommandLong) -> list[Message]:
        if message.command != 512:
            return [CommandAck(message.command, 0 if self.fault == "accepts any command" else 3)]
        reports: dict[int, Message] = {
            0: ALIVE,
            148: AutopilotVersion(0, 0, 1, 0, 0, 0, 0, 0, (0,) * 8, (0,) * 8, (0,) * 8),
        }
        told = self.fault != f"does not report {int(message.param1)}"
        return [CommandAck(512, 0), *([reports[int(message.param1)]] if told else [])]


class FreeRunningRobot(Robot):
    """Ticks by its own clock, and follows the newest command."""

    newest = followed = NO_COMMAND
    due = 0.0

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
        self.say_tick(tick)
        if self.fault == "repeats ticks" and tick % 16 == 0:
            self.say_tick(tick)
        self.followed = self.newest
        self.due += min(0.005 * 1.01**tick, 0.04) if self.fault == "tires" else 0.01
        self.tick = tick + (2 if self.fault == "leaves ticks out" and tick % 16 == 0 else 1)

    def silence(self) -> None:
        """It waits for nobody."""

    def in_force(self, _: int) -> int:
        return self.followed

    def hear_command(self, command: Command) -> None:
        if not math.isfinite(command.v):
            self.deaf = 1 if self.fault == "stumbles over NaN" else 0
        elif command.tick > self.newest or self.fault == "follows older commands":
            self.newest = command.tick


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
            self.send(ALIVE, *([] if secret else [Settings(0.01)]))

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
        command = Command(v, 0.0, tick, target, 1, 1)
        twice = self.fault == "answers twice" and tick > 19
        self.send(estimate, command, *([estimate, command] if twice else []))
