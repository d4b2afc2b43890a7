"""A run in one process: the station's core at the far end of the gateway's link."""

from time import sleep

from laglab_control import PluginFailedError
from laglab_protocol import Address, EndReason, Link, Receiver
from laglab_station import Station

LONGEST = 1.0
"""[s] A longer wait is several: systems refuse to sleep for ever."""


class InlineLink(Link):
    """A link whose far end is a station core, called directly."""

    name = "inline"
    datagrams = True

    def __init__(self, station: Station, receiver: Receiver) -> None:
        self._station = station
        self._receiver = receiver
        self._inbox = [b"".join(station.heartbeat())]
        self.problem = ""
        """How somebody's code failed, which ended the run."""

    def fileno(self) -> int:
        """There is nothing to wait for."""
        return -1

    def send(self, data: bytes, to: Address | None = None) -> None:
        """Hand the bytes to the station; its answer waits to be received. A station that fails says
        so as it would from a process of its own, and no more."""
        del to  # there is only one far end
        if self.problem:
            return
        try:
            answer = self._station.hear(self._receiver.receive(data, whole=True))
        except PluginFailedError as error:
            self.problem = str(error)
            answer = self._station.end(EndReason.FAILED)
        if answer:
            self._inbox.append(b"".join(answer))

    def receive(self, timeout: float) -> bytes:
        """The next answer; where there is none, nothing will come in time either."""
        if self._inbox:
            return self._inbox.pop(0)
        sleep(min(timeout, LONGEST))
        return b""
