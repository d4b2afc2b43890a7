"""How long one waits for bytes."""

import socket
from time import monotonic, sleep

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


def test_what_came_in_time_is_taken_however_late_it_is_found() -> None:
    """Held up between the look and the clock, which then says that it is over."""
    ours, theirs = socket.socketpair()
    looks = 0

    def read() -> bytes | None:
        nonlocal looks
        looks += 1
        if looks == 1:
            theirs.send(b"in time")
            sleep(0.05)
            return None
        return ours.recv(100)

    with ours, theirs:
        assert first_bytes(read, ours.fileno, 0.01) == b"in time"


def test_nothing_is_asked_for_once_where_there_is_no_time() -> None:
    ours, theirs = socket.socketpair()
    looks = []
    with ours, theirs:
        assert first_bytes(lambda: looks.append(1), ours.fileno, 0.0) == b""
    assert looks == [1]
