"""A relay between two machines that holds datagrams back and loses some: a link, for tests.

`relay.py LISTEN_HOST PORT TARGET_HOST UP DOWN JITTER LOSS`: what comes to HOST:PORT goes on to the
same port of the target UP seconds later, answers DOWN seconds later, each by an exponential JITTER
more; a share LOSS of all is lost. None overtakes another. It runs until it is killed.
"""

import heapq
import random
import select
import socket
import sys
from collections.abc import Iterator
from time import monotonic
from typing import NamedTuple


class Way(NamedTuple):
    """One direction, and what is on its way."""

    source: socket.socket
    delay: float
    flying: list[tuple[float, bytes]]


def relay(listen: tuple[str, int], target: tuple[str, int], link: "Link") -> None:
    near = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    near.bind(listen)
    far = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    far.connect(target)
    up, down = Way(near, link.up, []), Way(far, link.down, [])
    caller = None
    while True:
        waiting = [way.flying[0][0] for way in (up, down) if way.flying]
        wait = max(min(waiting) - monotonic(), 0) if waiting else None
        ready, _, _ = select.select([near, far], [], [], wait)
        for way in (up, down):
            if way.source in ready:
                try:
                    data, sender = way.source.recvfrom(65535)
                except ConnectionRefusedError:
                    continue  # nobody is at the target yet
                caller = sender if way is up else caller
                link.take(way, data)
        for data in due(up):
            send(far, data)
        for data in due(down):
            if caller is not None:
                near.sendto(data, caller)


def send(to: socket.socket, data: bytes) -> None:
    try:
        to.send(data)
    except ConnectionRefusedError:
        return  # of an earlier one


def due(way: Way) -> Iterator[bytes]:
    while way.flying and way.flying[0][0] <= monotonic():
        yield heapq.heappop(way.flying)[1]


class Link:
    """What becomes of a datagram."""

    def __init__(self, up: float, down: float, jitter: float, loss: float) -> None:
        self.up, self.down = up, down
        self._jitter, self._loss = jitter, loss
        self._random = random.Random(1)

    def take(self, way: Way, data: bytes) -> None:
        if self._random.random() < self._loss:
            return
        late = self._random.expovariate(1 / self._jitter) if self._jitter else 0.0
        last = max((at for at, _ in way.flying), default=0.0)
        heapq.heappush(way.flying, (max(monotonic() + way.delay + late, last + 1e-9), data))


if __name__ == "__main__":
    host, port, target, *link = sys.argv[1:]
    relay((host, int(port)), (target, int(port)), Link(*map(float, link)))
