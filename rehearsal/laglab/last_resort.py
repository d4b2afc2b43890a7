"""What ends a process that heeds no signal: it is in the midst of a call that never returns.

Python calls handlers between two of its own instructions, so not while somebody's FMU goes round
for ever. But a thread can hear of signals as the system does.
"""

import os
import select
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from laglab.interrupts import SIGNALS, leave, on_interrupt
from laglab_fmu import clear_unpacked

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
    if hasattr(os, "register_at_fork"):  # what a child of somebody's filter hears is not for us
        os.register_at_fork(after_in_child=partial(signal.set_wakeup_fd, -1))
    on_interrupt(meet)
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        tell.close()


def _leave_unless(met: threading.Event, told: socket.socket) -> None:
    with told:
        while came := told.recv(64):
            if not set(came) & set(SIGNALS):
                continue  # somebody's timer or child: no handler of ours is to meet it
            if not met.wait(UNHEARD):
                clear_unpacked()
                leave()
            met.clear()
            if select.select([told], [], [], 0.0)[0]:
                told.recv(64)  # met already, perhaps; who means it says it again
