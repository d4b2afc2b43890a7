"""UDP, both ways round: `udpin` waits for a peer, `udpout` goes to one."""

import ipaddress
import socket
from abc import ABC, abstractmethod
from types import TracebackType
from typing import Any, Self

from laglab_protocol.endpoints.interface import Address
from laglab_protocol.endpoints.waiting import first_bytes
from laglab_protocol.errors import EndpointError, NoSuchPortError, PortBusyError

LARGEST_DATAGRAM = 65535
NOBODY_THERE = (ConnectionRefusedError, ConnectionResetError)
"""As Linux and as Windows say it, on the next call, of a datagram that found nobody."""


class _Udp(ABC):
    datagrams = True
    sender: Address | None = None
    peer: Address | None = None

    def __init__(self, scheme: str, host: str, port: int) -> None:
        self._scheme = scheme
        family, self._address = _resolve(scheme, host, port)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    @property
    def name(self) -> str:
        return _spelled(self._scheme, self._address)

    @property
    def loopback(self) -> bool:
        return ipaddress.ip_address(self._address[0]).is_loopback

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()

    def accept_peer(self) -> None:
        return

    def reopen(self) -> None:
        return  # a socket outlives whoever is at the far end

    def receive(self, timeout: float) -> bytes:
        return first_bytes(self._read, self._socket.fileno(), timeout)

    @abstractmethod
    def _read(self) -> bytes | None:
        """A datagram that is there already; None when there is none."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()


class UdpIn(_Udp):
    """Bound to an address; sends to the peer last accepted (see Endpoint.accept_peer)."""

    def __init__(self, host: str, port: int) -> None:
        super().__init__("udpin", host, port)
        try:
            self._socket.bind(self._address)
        except OSError as error:
            self._socket.close()
            raise _cannot("bind", self.name, error) from error
        self._address = self._socket.getsockname()

    def send(self, data: bytes, to: Address | None = None) -> None:
        address: Any = to or self.peer
        if address is not None:
            try:
                self._socket.sendto(data, address)
            except BlockingIOError:
                return  # no room: lost, as on any way
            except OSError as error:
                where = f"{address[0]}:{address[1]}"
                raise _cannot(f"send to {where} from", self.name, error) from error

    def _read(self) -> bytes | None:
        try:
            data, self.sender = self._socket.recvfrom(LARGEST_DATAGRAM)
        except (BlockingIOError, *NOBODY_THERE):
            return None
        return data

    def accept_peer(self) -> None:
        self.peer = self.sender


class UdpOut(_Udp):
    """Connected to one far address; while nobody listens there, what is sent is lost."""

    def __init__(self, host: str, port: int) -> None:
        super().__init__("udpout", host, port)
        try:
            self._socket.connect(self._address)
        except OSError as error:
            self._socket.close()
            raise _cannot("reach", self.name, error) from error

    def send(self, data: bytes, to: Address | None = None) -> None:
        del to  # there is only one far end
        try:
            self._socket.send(data)
        except BlockingIOError:
            return  # no room: lost, as on any way
        except NOBODY_THERE:
            self._send_again(data)
        except OSError as error:
            raise _cannot("send to", self.name, error) from error

    def _send_again(self, data: bytes) -> None:
        """The refusal belonged to an earlier datagram, and this one was not sent."""
        try:
            self._socket.send(data)
        except (BlockingIOError, *NOBODY_THERE):
            return
        except OSError as error:
            raise _cannot("send to", self.name, error) from error

    def _read(self) -> bytes | None:
        try:
            return self._socket.recv(LARGEST_DATAGRAM)
        except (BlockingIOError, *NOBODY_THERE):
            return None  # a refusal means that an earlier datagram found nobody; it is used up


def _resolve(scheme: str, host: str, port: int) -> tuple[socket.AddressFamily, Any]:
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)
    except (OSError, UnicodeError) as error:  # no name at all, as far as encodings go
        raise NoSuchPortError(
            f"{scheme}://{host}:{port}: no such host {host!r}: give a name or address known here"
        ) from error
    return found[0][0], found[0][4]


def _spelled(scheme: str, address: Any) -> str:
    host = f"[{address[0]}]" if ":" in address[0] else address[0]
    return f"{scheme}://{host}:{address[1]}"


def _cannot(what: str, name: str, error: OSError) -> EndpointError:
    if isinstance(error, PermissionError):
        return NoSuchPortError(f"cannot {what} {name}: not permitted: take a port above 1023")
    if error.strerror == "Address already in use":
        return PortBusyError(
            f"cannot {what} {name}: the port is in use: end the other program or take another port"
        )
    return NoSuchPortError(f"cannot {what} {name}: {error.strerror}: check host and port")
