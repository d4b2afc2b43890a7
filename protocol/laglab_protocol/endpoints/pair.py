"""Two serial ports joined by a cable: a pty each, and the pace of a real line between them."""

import os
import select
from contextlib import ExitStack
from time import monotonic
from typing import Self

from laglab_protocol.endpoints.interface import Endpoint
from laglab_protocol.endpoints.terminals import make_pty, spelled_one_way
from laglab_protocol.endpoints.wire import Wire
from laglab_protocol.errors import PortBusyError


class Lane:
    """The way from the program at one port to the program at the other."""

    def __init__(self, source: Endpoint, destination: Endpoint, baud: int) -> None:
        self.source = source
        self.destination = destination
        self.carried = 0
        """Bytes that reached the other port."""
        self.overrun = 0
        """Bytes lost there because nobody had read what came before: a UART does not wait."""
        self.wire = Wire(baud)

    def take_in(self) -> None:
        """What was written to the port, as far as there is room for it."""
        data = os.read(self.source.fileno(), self.wire.room)
        self.wire.put(data, monotonic())

    def give_out(self) -> None:
        """What has crossed by now."""
        data = self.wire.take(monotonic())
        if not data:
            return
        try:
            written = os.write(self.destination.fileno(), data)
        except BlockingIOError:
            written = 0
        self.carried += written
        self.overrun += len(data) - written


class SerialPair:
    """Makes ports at two paths, which any two programs may open, close and open again."""

    def __init__(self, path_1: str, path_2: str, baud: int) -> None:
        """Raises NoSuchPortError, PortBusyError when a path cannot be had."""
        if spelled_one_way(path_1) == spelled_one_way(path_2):
            raise PortBusyError(f"{path_1}: two ports need two paths: choose another for one")
        with ExitStack() as stack:
            first, second = (stack.enter_context(make_pty(path)) for path in (path_1, path_2))
            self._ports = stack.pop_all()
        self.lanes = (Lane(first, second, baud), Lane(second, first, baud))

    def carry(self) -> None:
        """Carry bytes both ways until interrupted."""
        while True:
            self.carry_once(None)

    def carry_once(self, timeout: float | None) -> None:
        """Wait for the next bytes to come or to arrive, at most `timeout` [s], and pass them on."""
        reports = [lane.wire.next_report() for lane in self.lanes]
        waits = [max(due - monotonic(), 0.0) for due in reports if due is not None]
        with_room = {each.source: each for each in self.lanes if each.wire.room}
        limits = [*waits, *([] if timeout is None else [timeout])]
        ready, _, _ = select.select(with_room, [], [], min(limits, default=None))
        for lane in self.lanes:  # first: behind what crossed while we were held up the line is idle
            lane.give_out()
        for port in ready:
            with_room[port].take_in()

    def close(self) -> None:
        """Pull the cable: who holds a port is told that the far end is gone."""
        self._ports.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
