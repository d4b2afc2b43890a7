"""A function of ours in a process of its own: orders go in, reports come out.

Not `multiprocessing`, which runs the caller's own script again in every child. Orders go in on the
child's standard input, a line each, which stays open: its end, whatever became of us, asks the
child to end in order; who else reads there, as `input()` and a debugger do, finds it at its end.
Reports come out on its standard output, a line each; what else is printed there goes to standard
error. Its temporary files are in a folder of its own, which both clear: it
may crash, and we may be killed.

    python -P -m laglab.runs.processes.child MODULE:FUNCTION once|again FOLDER

-P: the current directory may have a `random.py` of its own, which is not to be the library's.
"""

import importlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from io import FileIO
from queue import Empty, Queue
from time import sleep
from typing import Any, NamedTuple, NoReturn

import msgspec
from msgspec import Struct

from laglab.interrupts import INTERRUPTED, on_interrupt
from laglab.runs.processes.reports import Ended, Report

LAST_CHANCE = 2.0
"""[s] After this long a child that was asked to end is killed."""
HEEDED_WITHIN = 10.0
"""[s] A child whose parent is gone, and which goes on for so long after that, does not heed it."""
LOOK_UP = 0.5
"""[s] How often a wait for reports looks up: not every system lets a Ctrl-C through it."""

Tell = Callable[[Report], None]

_decode = msgspec.json.Decoder(Report).decode


@dataclass(frozen=True)
class Child:
    """A running child; what it says comes in the inbox that it was started with."""

    name: str
    process: "subprocess.Popen[bytes]"

    def order(self, order: Struct) -> None:
        """Another one, for a child that waits for more. One that is gone does not hear it."""
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):
            self.process.stdin.write(msgspec.json.encode(order) + b"\n")
            self.process.stdin.flush()

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
def started(
    name: str, target: str, order: Struct, inbox: Inbox, again: bool = False
) -> Iterator[Child]:
    """The function `target`, MODULE:FUNCTION, called with `order`; gone when the context ends.

    `again`: with each order that comes after it, too.
    """
    arguments = (target, "again" if again else "once")
    with tempfile.TemporaryDirectory(prefix="laglab-", ignore_cleanup_errors=True) as folder:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "laglab.runs.processes.child", *arguments, folder],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # a Ctrl-C in the terminal is for us, who end it
            env=os.environ | {"TMPDIR": folder},
        )
        child = Child(name, process)
        reader = threading.Thread(target=_read, args=(child, inbox), daemon=True)
        reader.start()
        try:
            child.order(order)
            yield child
        finally:
            _end(process)
            reader.join()


def _end(process: "subprocess.Popen[bytes]") -> None:
    assert process.stdin is not None
    with suppress(BrokenPipeError):
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
            with suppress(msgspec.DecodeError):  # not ours, or it died in the middle of it
                inbox.put(Letter(child, _decode(line)))
    how = _how_it_ended(child.process.wait())
    inbox.put(Letter(child, Ended(f"the {child.name} process {how}")))


def _how_it_ended(exit_code: int) -> str:
    if exit_code >= 0:
        return f"ended with exit code {exit_code} and no word"
    with suppress(ValueError):
        return f"was killed by {signal.Signals(-exit_code).name}"
    return f"was killed by signal {-exit_code}"


def main(target: str, again: bool) -> None:
    """In the child: call the function with the order that comes in, or with each."""
    signal.signal(signal.SIGINT, _leave)  # whatever our parent's parent had it ignore
    on_interrupt(_leave)
    with FileIO(os.dup(1), "wb") as out:
        os.dup2(2, 1)  # an FMU that prints must not disturb the reports
        source, orders = _source_of_orders(), Queue[bytes]()
        orders.put(_line(source) or _leave())
        threading.Thread(target=_read_on, args=(source, orders), daemon=True).start()
        module, _, name = target.partition(":")
        function: Callable[[Any, Tell], None] = getattr(importlib.import_module(module), name)
        on_interrupt(signal.default_int_handler)
        while True:
            function(_order_of(function, _next(orders)), lambda report: _tell(out, report))
            if not again:
                break
        on_interrupt(_leave)


def _leave(*_: object) -> NoReturn:
    """At once: there is nothing to end in order yet, or any more. Nor is there anything to be
    interrupted a second time, as when a parent that is gone is found gone twice."""
    with suppress(KeyboardInterrupt):
        on_interrupt(lambda *_: None)
    _vanish()


def _vanish() -> NoReturn:
    shutil.rmtree(sys.argv[3], ignore_errors=True)
    os._exit(INTERRUPTED)


def _source_of_orders() -> int:
    """Our standard input, for us alone: it never ends while we run, and whoever else read there, as
    `breakpoint()` does, would wait for as long. They get one that is empty."""
    source = os.dup(0)
    empty = os.open(os.devnull, os.O_RDONLY)
    os.dup2(empty, 0)
    os.close(empty)
    return source


def _line(source: int) -> bytes:
    """The next one, empty at the end; read without a buffer, whose lock would outlive us at our
    end."""
    line = b""
    while not line.endswith(b"\n"):
        piece = os.read(source, 1 << 16)  # nobody sends an order before the last one is done
        if not piece:
            return b""
        line += piece
    return line


def _read_on(source: int, orders: Queue[bytes]) -> None:
    """Whatever comes; at the end our parent is gone, or wants us to go. Then it sees to that, but
    who is gone does not, and an `except:` of somebody's may have swallowed the interrupt."""
    parent = os.getppid()
    while line := _line(source):
        orders.put(line)
    _interrupt()
    sleep(HEEDED_WITHIN)
    if os.getppid() != parent:
        _vanish()


def _interrupt() -> None:
    """Our main thread, even where it waits for its peer."""
    main_thread = threading.main_thread().ident
    if hasattr(signal, "pthread_kill") and main_thread is not None:
        signal.pthread_kill(main_thread, signal.SIGINT)
    else:
        signal.raise_signal(signal.SIGINT)


def _next(orders: Queue[bytes]) -> bytes:
    while True:
        with suppress(Empty):
            return orders.get(timeout=LOOK_UP)


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


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2] == "again")
    except KeyboardInterrupt:
        _leave()
    finally:
        shutil.rmtree(sys.argv[3], ignore_errors=True)
