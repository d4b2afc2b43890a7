"""A turn, played: both sides as real processes, the blow, the strangers, and a look at them all."""

import os
import re
import shutil
import signal
import uuid
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep

from laglab.soak.played import Played
from laglab.soak.process import Process
from laglab.soak.reference import fault_of_trace
from laglab.soak.strangers import LINE_SHARE, Speaking, speaking
from laglab.soak.system import PROCESSES, marked
from laglab.soak.turn import Side, Turn
from laglab_gateway import TRACE_FILE
from laglab_protocol import make_key

LOOK_EVERY = 0.05
"""[s]"""
LAST_WORDS = 60.0
"""[s] Besides the silence: results, shadows and a figure, on a machine that is busy."""
UNMET = 3.0
"""[s] A side that met nobody waits for ever; once the other one is over it gets this long."""
LONGEST = 300.0
"""[s] A turn that takes longer is broken off."""
BAUD = 57600
SCENARIO, KEY, PORT, WATCH = "scenario.toml", "key", "port", "watch"


def play(turn: Turn, folder: Path) -> Played:
    """In a folder of its own, which is made anew. Raises ScenarioError, OSError."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    scenario = turn.scenario()
    (folder / SCENARIO).write_text(scenario.to_toml(folder), encoding="utf-8")
    if turn.signed:
        make_key(folder / KEY)
    before = _descriptors()
    mark = uuid.uuid4().hex
    with _cast(turn, folder, mark) as stage:
        while not stage.over:
            stage.go_on()
            sleep(LOOK_EVERY)
        running = _rounded_up(mark)
    parts = tuple(process.part() for process in stage.processes)
    links = tuple(path.name for path in folder.iterdir() if path.is_symlink())
    return Played(
        turn=turn,
        parts=parts,
        trace_fault=_trace_fault(folder) if turn.lockstep and turn.goes_on else None,
        left=links,
        running=tuple(running),
        descriptors=(before, _descriptors()),
        datagrams=stage.datagrams,
    )


def _rounded_up(mark: str) -> list[int]:
    """The processes of the turn that still ran; they are killed."""
    running = marked(mark)
    for number in running:
        with suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)
    return running


def _trace_fault(folder: Path) -> str:
    trace = folder / "gateway" / TRACE_FILE
    return fault_of_trace(trace, folder / SCENARIO, folder / "inline")


def _descriptors() -> int:
    """Of our own that are open."""
    return len(list((PROCESSES / "self" / "fd").iterdir()))


@contextmanager
def _cast(turn: Turn, folder: Path, mark: str) -> Iterator["_Stage"]:
    """Whoever is still there at the end is killed."""
    with ExitStack() as stack:
        stage = _Stage(turn, folder, mark, stack)
        stack.callback(stage.clear)
        yield stage


class _Stage:
    """The turn so far."""

    def __init__(self, turn: Turn, folder: Path, mark: str, stack: ExitStack) -> None:
        self._turn = turn
        self._folder = folder
        self._mark = mark
        self._stack = stack
        self._began = monotonic()
        self._under_way: float | None = None
        self._struck: Process | None = None
        self._speaking: Speaking | None = None
        self.processes: list[Process] = []
        self.gateway = self._start("gateway", *self._gateway_links(0))
        self.controller: Process | None = None

    @property
    def over(self) -> bool:
        """Whether nobody runs any more."""
        return not any(process.running for process in self.processes)

    @property
    def datagrams(self) -> int:
        """How many strangers have sent."""
        return self._speaking.sent if self._speaking else 0

    def clear(self) -> None:
        """Whoever still runs is killed."""
        for process in self.processes:
            process.kill()

    def go_on(self) -> None:
        """Look at everybody, and do what is due."""
        for process in self.processes:
            process.look()
            process.go_on_again()
        self._send_home()
        if self.controller is None:
            if "waiting for the controller" in self.gateway.said:
                self.controller = self._start("controller", "--endpoint", self._far_end())
            return
        if self._under_way is None and self.gateway.met and self.controller.met:
            self._under_way = monotonic()
        self._strike(self.controller)
        self._let_strangers_speak()

    def _start(self, side: Side, *arguments: str) -> Process:
        scenario = str(self._folder / SCENARIO)
        key = ("--key", str(self._folder / KEY)) if self._turn.signed else ()
        again = any(process.side == side for process in self.processes)
        folder = self._folder / (f"{side}-again" if again else side)
        process = Process(side, (scenario, *arguments, *key), folder, self._mark)
        self.processes.append(process)
        return process

    def _gateway_links(self, port: int) -> tuple[str, ...]:
        serial = self._turn.transport == "serial"
        loop = f"pty://{self._folder / PORT}" if serial else f"udpin://127.0.0.1:{port}"
        watch = f"pty://{self._folder / WATCH}" if serial else "udpin://127.0.0.1:0"
        return "--endpoint", loop, *(("--watch", watch) if self._turn.strangers else ())

    def _far_end(self) -> str:
        if self._turn.transport == "serial":
            return f"serial://{self._folder / PORT}:{BAUD}"
        return f"udpout://127.0.0.1:{self._ports()[0]}"

    def _ports(self) -> list[int]:
        """Of the gateway: the loop's, and the one to watch it on."""
        return [int(port) for port in re.findall(r" udpin://127\.0\.0\.1:(\d+)", self.gateway.said)]

    def _strike(self, controller: Process) -> None:
        blow = self._turn.blow
        if blow is None:
            return
        victim, other = self.gateway, controller
        if blow.side == "controller":
            victim, other = other, victim
        since = controller.started_at if blow.early else self._under_way
        due = since is not None and monotonic() - since >= blow.after
        if self._struck is None and due and victim.running and victim.obeys:
            self._struck = victim
            victim.strike(blow.signal)
        elif blow.again and victim is self._struck and not victim.running and other.running:
            self._start_again(blow.side)

    def _start_again(self, side: Side) -> None:
        if side == "controller":
            self.controller = self._start(side, "--endpoint", self._far_end())
        else:
            port = 0 if self._turn.transport == "serial" else self._ports()[0]
            self.gateway = self._start(side, *self._gateway_links(port))

    def _let_strangers_speak(self) -> None:
        turn = self._turn
        if self._speaking or not turn.strangers or self._under_way is None:
            return
        serial = turn.transport == "serial"
        lines = {self._folder / PORT: LINE_SHARE, self._folder / WATCH: 1.0} if serial else {}
        with suppress(OSError):  # the run is over already
            self._speaking = self._stack.enter_context(
                speaking(turn.strangers, turn.rate, [] if serial else self._ports(), lines)
            )

    def _send_home(self) -> None:
        """Who has nobody left to speak to, and does not end."""
        for process in self.processes:
            if process.running and process.obeys and self._waits_in_vain(process):
                process.send_home()

    def _waits_in_vain(self, process: Process) -> bool:
        now = monotonic()
        if now - self._began > LONGEST:
            return True
        others = [other for other in self.processes if other is not process]
        if any(other.running for other in others):
            return False
        alone_for = now - max((other.ended_at or now for other in others), default=now)
        return alone_for > (self._turn.patience + LAST_WORDS if process.met else UNMET)
