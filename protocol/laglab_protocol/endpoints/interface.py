"""The narrow interface of every link, and of every endpoint."""

from abc import ABC, abstractmethod
from collections.abc import Hashable
from typing import Self

Address = Hashable
"""Whoever speaks from one place; only the endpoint that gave it can read it."""


class Link(ABC):
    """What a talk needs of one end of a link. Any method may raise an EndpointError; none is safe
    across threads. What is written out here suits a link that has one far end, which stays."""

    name: str
    """The actual address, such as "udpin://127.0.0.1:40123" after binding port 0."""
    datagrams: bool
    """True when `receive` returns one datagram, False when it returns a piece of a stream."""
    sender: Address | None = None
    """Whom the last datagram came from; None where there is only one far end."""
    peer: Address | None = None
    """Whom `send` sends to: None before anybody was accepted, or if there is one far end."""

    @abstractmethod
    def fileno(self) -> int:
        """A descriptor that is readable when `receive` would return at once; -1 if there is none,
        because the far end is in this very process."""

    @abstractmethod
    def send(self, data: bytes, to: Address | None = None) -> None:
        """Send `data` as one datagram, or as it comes in a stream: to the peer, or to a `sender`.

        Dropped when nobody has been accepted yet (udpin), or when the far end has read nothing for
        long: whoever waits for an answer will find it silent. Raises FarEndGoneError where the link
        can tell.
        """

    def offer(self, data: bytes, to: Address | None = None) -> None:
        """Send whole `data` without waiting, or nothing where there is no room for it now.

        Raises FarEndStalledError when there has been no room for long.
        """
        self.send(data, to)

    @abstractmethod
    def receive(self, timeout: float) -> bytes:
        """What arrived within `timeout` seconds, b"" when nothing did."""

    def accept_peer(self) -> None:
        """From now on send to where the last datagram came from.

        For udpin, which has no peer of its own: call it when that datagram held a frame that you
        accept, so that a stranger's garbage cannot take the link. Nothing happens elsewhere.
        """
        return

    def leave_peer(self) -> None:
        """The talk with the peer is over: udpin has no peer, and hears all alike, until another
        is accepted. Nothing happens elsewhere.
        """
        return

    def reopen(self) -> None:
        """After FarEndGoneError: open the same again. Raises EndpointError when that fails."""
        return


class Endpoint(Link):
    """One end of a link that was opened, and is to be closed."""

    @property
    @abstractmethod
    def loopback(self) -> bool:
        """True when only programs on this machine can reach this endpoint."""

    @abstractmethod
    def close(self) -> None:
        """Give everything back. May be called twice."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
