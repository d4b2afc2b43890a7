"""A function of ours in a process of its own: an order goes in, reports come out.

Not `multiprocessing`, which runs the caller's own script again in every child. The order goes in on
the child's standard input, which stays open: its end, whatever became of us, asks the child to
end in order. Reports come out on its standard output, a line each; what else is printed there goes
to standard error.

    python -m laglab.runs.child MODULE:FUNCTION
"""

import importlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import FileIO
from queue import Queue
from typing import Any, NamedTuple, NoReturn

import msgspec
from msgspec import Struct

from laglab.interrupts import INTERRUPTED, on_interrupt
from laglab.runs.reports import Ended, Report

LAST_CHANCE = 2.0
"""[s] A child that was asked to end is ended after so long."""
LOOK_UP = 0.5
"""[s] So often a wait for reports looks up: not every system lets a Ctrl-C through it."""

Tell = Callable[[Report], None]

_decode = msgspec.json.Decoder(Report).decode


@dataclass(frozen=True)
class Child:
    """A running child; what it says comes in the inbox that it was started with."""

    name: str
    process: "subprocess.Popen[bytes]"

    def stop(self) -> None:
        """Ask it to end in order."""
        assert self.process.stdin is not None
        self.process.stdin.close()


class Letter(NamedTuple):
    """What a child said."""

    sender: Child
    report: Report


Inbox = Queue[Letter]


@contextmanager
def started(name: str, target: str, order: Struct, inbox: Inbox) -> Iterator[Child]:
    """The function `target`, MODULE:FUNCTION, called with `order`; gone when the context ends."""
    process = subprocess.Popen(
        [sys.executable, "-m", "laglab.runs.child", target],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,  # a Ctrl-C in the terminal is for us, who end it
    )
    child = Child(name, process)
    reader = threading.Thread(target=_read, args=(child, inbox), daemon=True)
    reader.start()
    try:
        assert process.stdin is not None
        process.stdin.write(msgspec.json.encode(order) + b"\n")
        process.stdin.flush()
        yield child
    finally:
        _end(process)
        reader.join()


def _end(process: "subprocess.Popen[bytes]") -> None:
    assert process.stdin is not None
    process.stdin.close()
    try:
        process.wait(LAST_CHANCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _read(child: Child, inbox: Inbox) -> None:
    assert child.process.stdout is not None
    with child.process.stdout as lines:
        for line in lines:
            inbox.put(Letter(child, _decode(line)))
    how = _how_it_ended(child.process.wait())
    inbox.put(Letter(child, Ended(f"the {child.name} process {how}")))


def _how_it_ended(exit_code: int) -> str:
    if exit_code < 0:
        return f"was killed by {signal.Signals(-exit_code).name}"
    return f"ended with exit code {exit_code} and no word"


def main(target: str) -> None:
    """In the child: call the function with the order that comes in."""
    signal.signal(signal.SIGINT, _leave)  # whatever our parent's parent had it ignore
    on_interrupt(_leave)
    with FileIO(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # an FMU that prints must not disturb the reports
        order = _first_line()
        threading.Thread(target=_end_with_our_parent, daemon=True).start()
        module, _, name = target.partition(":")
        function: Callable[[Any, Tell], None] = getattr(importlib.import_module(module), name)
        on_interrupt(signal.default_int_handler)
        function(_order_of(function, order), lambda report: _tell(out, report))
        on_interrupt(_leave)


def _leave(*_: object) -> NoReturn:
    """At once: there is nothing to end in order yet, or any more."""
    os._exit(INTERRUPTED)


def _first_line() -> bytes:
    """Of standard input; read without a buffer, whose lock would outlive us at our end."""
    line = b""
    while not line.endswith(b"\n"):
        piece = os.read(0, 1 << 16)
        if not piece:
            _leave()  # our parent is gone
        line += piece
    return line


def _order_of(function: Callable[[Any, Tell], None], order: bytes) -> Struct:
    """As the type of the function's first parameter says."""
    kind = next(iter(function.__annotations__.values()))
    decoded: Struct = msgspec.json.decode(order, type=kind)
    return decoded


def _tell(out: FileIO, report: Report) -> None:
    line = memoryview(msgspec.json.encode(report) + b"\n")
    try:
        while line:
            line = line[out.write(line) :]
    except BrokenPipeError:
        raise KeyboardInterrupt from None  # nobody waits for us any more


def _end_with_our_parent() -> None:
    while os.read(0, 1):
        pass
    signal.raise_signal(signal.SIGINT)


if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except KeyboardInterrupt:
        _leave()
