"""How long one waits for bytes."""

import socket
from time import monotonic

from laglab_protocol.endpoints.waiting import POLLED, first_bytes, writable


def test_who_waits_for_ever_does_so() -> None:
    """Systems refuse to sleep for longer than they can count."""
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.send(b"at last")
        late = monotonic() + 4 * POLLED  # no poll lasts so long: it has to sleep
        read = first_bytes(
            lambda: ours.recv(100) if monotonic() > late else None, ours.fileno, 1e300
        )
        assert read == b"at last"
        assert writable(theirs.fileno(), 1e300)
