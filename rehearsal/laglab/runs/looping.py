"""What stands around a loop, whichever it is."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from laglab.interrupts import FINISHING, put_off
from laglab.runs.pauses import short_pauses
from laglab.runs.staying import staying


@contextmanager
def looping(last: ExitStack | None) -> Iterator[None]:
    """Interrupts end what is within; then they wait until `last` is closed, if there is one."""
    try:
        with short_pauses(), staying():
            yield
    finally:
        wait_for(last)


def wait_for(last: ExitStack | None) -> None:
    """From now on an interrupt does."""
    if last is not None:
        last.enter_context(put_off(FINISHING))
