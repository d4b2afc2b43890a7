"""Both sides in one process: the same bytes, with nothing between them."""

from laglab_controller import Station


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

    def receive(self, timeout: float) -> bytes:  # noqa: ARG002 (an answer is there or never comes)
        """The next answer, or nothing."""
        return self._inbox.pop(0) if self._inbox else b""

    def accept_peer(self) -> None:
        """There is no other peer."""
