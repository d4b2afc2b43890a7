"""What ends a process that heeds no signal: it is in the midst of a call that never returns.

Python calls handlers between two of its own instructions, so not while somebody's FMU goes round
for ever. But a thread can hear of signals as the system does.
"""

import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from laglab.interrupts import leave, on_interrupt

UNHEARD = 10.0
"""[s] A signal that no handler has met by then meets none any more."""


@contextmanager
def never_in_vain(handler: Callable[..., object]) -> Iterator[None]:
    """Call the handler from now on; while the context lasts, a signal that it does not meet ends
    the process all the same."""
    told, tell = socket.socketpair()
    met = threading.Event()

    def meet(*arguments: object) -> None:
        met.set()
        handler(*arguments)

    tell.setblocking(False)
    before = signal.set_wakeup_fd(tell.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_leave_unless, args=(met, told), daemon=True).start()
    on_interrupt(meet)
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        tell.close()


def _leave_unless(met: threading.Event, told: socket.socket) -> None:
    with told:
        while told.recv(64):
            if not met.wait(UNHEARD):
                leave()
            met.clear()
