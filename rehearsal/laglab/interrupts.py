"""What ends a process from outside: Ctrl-C, SIGTERM, and a terminal that closes."""

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import NoReturn

INTERRUPTED = 130


SIGNALS = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]


def on_interrupt(handler: Callable[..., object]) -> None:
    """Call the handler from now on; a signal that we were started to ignore stays ignored."""
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handler)


FINISHING = b"finishing what is begun; one more interrupt leaves it undone\n"


@contextmanager
def put_off(notice: bytes = b"") -> Iterator[None]:
    """The first interrupt waits until what the context does is done, of which `notice` tells on
    standard error; a second one does not."""
    handlers = {number: signal.getsignal(number) for number in SIGNALS}
    came: list[int] = []

    def later(number: int, frame: FrameType | None) -> None:
        came.append(number)
        handler = handlers[number]
        if callable(handler):
            with suppress(KeyboardInterrupt):
                handler(number, frame)  # it may keep in mind that it was called
        if came[1:]:
            raise KeyboardInterrupt
        with suppress(OSError):
            os.write(2, notice)

    on_interrupt(later)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    if came:
        raise KeyboardInterrupt


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
