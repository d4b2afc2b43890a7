"""Both sides in one process: the same bytes, with nothing between them."""

from time import sleep

from laglab_station import Station


class InlineEndpoint:
    """An endpoint whose far end is a station core, called directly."""

    datagrams = True

    def __init__(self, station: Station) -> None:
        self._station = station
        self._inbox = [station.heartbeat()]

    def send(self, data: bytes) -> None:
        """Hand the bytes to the station; its answer waits to be received."""
        if answer := self._station.receive(data, datagram=True):
            self._inbox.append(answer)

    def receive(self, timeout: float) -> bytes:
        """The next answer; where there is none, nothing will come in time either."""
        if self._inbox:
            return self._inbox.pop(0)
        sleep(timeout)
        return b""

    def accept_peer(self) -> None:
        """There is no other peer."""
