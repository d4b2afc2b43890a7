"""What people send who are no part of a run, and who sends it."""

import itertools
import os
import socket
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from time import monotonic

from laglab.soak.turn import Strangers
from laglab_protocol import (
    STATION_COMPONENT,
    STATION_HEARTBEAT,
    STATION_SYSTEM,
    Command,
    End,
    EndReason,
    Heartbeat,
    ParamRequestList,
    Ping,
    Sender,
    Signer,
)

ANOTHER_KEY = bytes(32)
HEARTBEAT = Heartbeat(0, 6, 8, 0, 4, 3)
LOOPBACK = "127.0.0.1"
LINE_SHARE = 0.02
"""The share of what strangers send on the loop's own line, which has no room for more."""

Say = Callable[[bytes], None]


def datagrams(who: Strangers) -> list[bytes]:
    """What such a stranger says, again and again; none of it is for anybody in the run."""
    stranger, station = Sender(7, 7), Sender(STATION_SYSTEM, STATION_COMPONENT)
    command, end = Command(1.0, 1.0, 100, 1, 1, 0), End(100, EndReason.FAILED)
    match who:
        case "garbage":
            return [b"\xfd" * 1400, b"\xfd", bytes(range(256)), b"\xfe\xff" * 30]
        case "foreign frames":
            return [stranger.frame(HEARTBEAT) * 40, stranger.frame(command) + stranger.frame(end)]
        case "requests":
            return [stranger.frame(ParamRequestList(1, 1)) * 60, stranger.frame(Ping(1, 1, 0, 0))]
        case "bad signatures":
            signed = Sender(200, 190, Signer(ANOTHER_KEY, (0, 200, 190)))
            return [b"".join(signed.frame(HEARTBEAT) for _ in range(20)), signed.frame(end)]
        case "an impostor":
            return [station.frame(each) for each in (STATION_HEARTBEAT, command, end)]


class Speaking:
    """Strangers that talk in a thread, until the context ends."""

    def __init__(self, said: Sequence[bytes], places: Mapping[Say, float], rate: float) -> None:
        """`places`: where it is said, each with its share of the `rate` [1/s]."""
        self.sent = 0
        self._said = itertools.cycle(said)
        self._places = places
        self._rate = rate
        self._over = threading.Event()

    @contextmanager
    def going_on(self) -> Iterator["Speaking"]:
        """While the context lasts."""
        thread = threading.Thread(target=self._speak)
        thread.start()
        try:
            yield self
        finally:
            self._over.set()
            thread.join()

    def _speak(self) -> None:
        began, owed = monotonic(), dict.fromkeys(self._places, 0)
        while not self._over.wait(0.005):
            elapsed = monotonic() - began
            for say, share in self._places.items():
                for _ in range(int(elapsed * self._rate * share) - owed[say]):
                    with suppress(OSError):  # they go on where nobody listens or there is no room
                        say(next(self._said))
                        self.sent += 1
                owed[say] = int(elapsed * self._rate * share)


@contextmanager
def speaking(
    who: Sequence[Strangers], rate: float, ports: Sequence[int], lines: Mapping[Path, float]
) -> Iterator[Speaking]:
    """To UDP ports on loopback, and into serial lines, of which each has its share of the rate.
    Raises OSError."""
    said = [data for each in who for data in datagrams(each)]
    with ExitStack() as stack:
        places: dict[Say, float] = {}
        if ports:
            ours = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            places |= {_to_port(ours, port): 1 / len(ports) for port in ports}
        places |= {_into_line(stack, path): share for path, share in lines.items()}
        yield stack.enter_context(Speaking(said, places, rate).going_on())


def _to_port(ours: socket.socket, port: int) -> Say:
    def say(data: bytes) -> None:
        ours.sendto(data, (LOOPBACK, port))

    return say


def _into_line(stack: ExitStack, path: Path) -> Say:
    """Nobody reads what comes back."""
    descriptor = os.open(path, os.O_WRONLY | os.O_NOCTTY | os.O_NONBLOCK)
    stack.callback(os.close, descriptor)

    def say(data: bytes) -> None:
        os.write(descriptor, data)

    return say
