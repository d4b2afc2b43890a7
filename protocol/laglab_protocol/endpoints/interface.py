"""The narrow thing that every endpoint is."""

from types import TracebackType
from typing import Protocol, Self


class Endpoint(Protocol):
    """One end of a link. Any method may raise an EndpointError; none is safe across threads."""

    @property
    def name(self) -> str:
        """The actual address, such as "udpin://127.0.0.1:40123" after binding port 0."""

    @property
    def datagrams(self) -> bool:
        """True when `receive` returns one datagram, False when it returns a piece of a stream."""

    @property
    def loopback(self) -> bool:
        """True when only programs on this machine can reach this endpoint."""

    def fileno(self) -> int:
        """A descriptor that is readable when `receive` would return at once."""

    def send(self, data: bytes) -> None:
        """Send `data` as one datagram, or as it comes in a stream.

        Dropped when nobody has been accepted yet (udpin). Raises FarEndGoneError or
        FarEndStalledError where the link can tell.
        """

    def receive(self, timeout: float) -> bytes:
        """What arrived within `timeout` seconds, b"" when nothing did."""

    def accept_peer(self) -> None:
        """From now on send to where the last datagram came from.

        For udpin, which has no peer of its own: call it when that datagram held a frame that you
        accept, so that a stranger's garbage cannot take the link. Nothing happens elsewhere.
        """

    def close(self) -> None:
        """Give everything back. May be called twice."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None: ...
