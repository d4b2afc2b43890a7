"""One direction of a serial line, without I/O or clock: bytes take their time."""

BITS_PER_BYTE = 10
"""A start bit, eight data bits, a stop bit: 8N1, as nearly every port is set."""

TRANSMIT_BUFFER = 4096
"""Bytes that a port's driver takes before whoever writes has to wait, as on Linux."""

FIFO = 16
"""Bytes after which a UART's receiver reports at the latest (a 16550's queue)."""

ROUNDING = 1e-6
"""A byte that lacks this little of its time has crossed: times are sums of doubles."""


class Wire:
    """Takes bytes, TRANSMIT_BUFFER at most, and gives them back in order, at the line's rate.

    All times are in seconds of the caller's clock, which must not go back.
    """

    def __init__(self, baud: int) -> None:
        self._bytes_per_second = baud / BITS_PER_BYTE
        self._waiting = bytearray()
        self._busy_until = 0.0
        """When the last byte that was taken had crossed: the next one starts no earlier."""

    @property
    def room(self) -> int:
        """Bytes that `put` takes now."""
        return TRANSMIT_BUFFER - len(self._waiting)

    def put(self, data: bytes, now: float) -> None:
        """Start sending; at most `room` bytes."""
        if not self._waiting:
            self._busy_until = max(self._busy_until, now)
        self._waiting += data

    def take(self, now: float) -> bytes:
        """The bytes that have crossed by now and have not been taken yet."""
        crossed = int((now - self._busy_until) * self._bytes_per_second + ROUNDING)
        taken = bytes(self._waiting[: max(crossed, 0)])
        del self._waiting[: len(taken)]
        self._busy_until += len(taken) / self._bytes_per_second
        return taken

    def next_report(self) -> float | None:
        """When the receiver reports again: at a full FIFO, or at the last byte; None when idle."""
        if not self._waiting:
            return None
        return self._busy_until + min(len(self._waiting), FIFO) / self._bytes_per_second
