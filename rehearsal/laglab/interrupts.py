"""What ends a process from outside: Ctrl-C, SIGTERM, and a terminal that closes."""

import os
import signal
from collections.abc import Callable
from contextlib import suppress
from typing import NoReturn

INTERRUPTED = 130


def on_interrupt(handler: Callable[..., object]) -> None:
    """Call the handler from now on; a signal that we were started to ignore stays ignored."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handler)


def deafen() -> None:
    """No Ctrl-C from now on, and none that came before: one that met Python while it executed a
    string, as it does to make a dataclass, would be sent once more at its very end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    exec("")  # with the next string it forgets that one


def leave(*_: object) -> NoReturn:
    """At once, while there is nothing to end in order. No exception: the loading of modules runs
    code through which none passes."""
    with suppress(OSError):
        os.write(2, b"laglab: interrupted\n")
    os._exit(INTERRUPTED)
