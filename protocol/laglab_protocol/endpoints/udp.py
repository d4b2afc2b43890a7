"""UDP, both ways round: `udpin` waits for a peer, `udpout` goes to one."""

import errno
import ipaddress
import selectors
import socket
from abc import abstractmethod
from time import monotonic
from typing import Any

from laglab_protocol.endpoints.apart import queue_for
from laglab_protocol.endpoints.interface import Address, Endpoint
from laglab_protocol.endpoints.waiting import first_bytes
from laglab_protocol.errors import EndpointError, NoSuchPortError, PortBusyError
from laglab_protocol.ration import LEAST_BYTES, Ration

LARGEST_HEARD = 65535
NOBODY_THERE = (ConnectionRefusedError, ConnectionResetError)
"""As Linux and as Windows say it, on the next call, of a datagram that found nobody."""

STRANGERS_DATAGRAM = 2048
"""Bytes that are read of a stranger's datagram: more than a path carries in one piece."""

STRANGERS_A_SECOND = 8192
"""Bytes that are read from strangers while there is a peer: a ground station sends a tenth."""
STRANGERS_EVERY = 2e-4
"""[s] Between two looks for them while there is a peer."""


class _Udp(Endpoint):
    datagrams = True

    def __init__(self, scheme: str, host: str, port: int) -> None:
        family, self._address = _resolve(scheme, host, port)
        self.name = _spelled(scheme, self._address)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    @property
    def loopback(self) -> bool:
        return ipaddress.ip_address(self._address[0]).is_loopback

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()

    def receive(self, timeout: float) -> bytes:
        return first_bytes(self._read, self.fileno, timeout)

    @abstractmethod
    def _read(self) -> bytes | None:
        """A datagram that is there already; None when there is none."""


class UdpIn(_Udp):
    """Bound to an address; sends to the peer last accepted (see Link.accept_peer).

    The peer has a queue of its own, and is heard before strangers, who are rationed. Where the
    system gives it none, everybody is heard as they come.
    """

    def __init__(self, host: str, port: int) -> None:
        super().__init__("udpin", host, port)
        try:
            self._socket.bind(self._address)
        except OSError as error:
            self._socket.close()
            raise _cannot("bind", self.name, error) from error
        self.name = _spelled("udpin", self._socket.getsockname())
        self._apart: socket.socket | None = None
        self._may_hold_older = False
        """Whether what the peer sent before it had a queue may still wait among everybody's."""
        self._next_look = 0.0
        self._strangers = Ration(STRANGERS_A_SECOND, STRANGERS_DATAGRAM, LEAST_BYTES)
        self._ready = selectors.DefaultSelector()
        self._watched: set[socket.socket] = set()

    def fileno(self) -> int:
        """One for all the queues that may be read now."""
        if self._apart is None:
            return self._socket.fileno()
        self._watch({self._apart, *([self._socket] if self._may_hear_strangers else [])})
        return self._ready.fileno()

    def _watch(self, queues: set[socket.socket]) -> None:
        for gone in self._watched - queues:
            self._ready.unregister(gone)
        for new in queues - self._watched:
            self._ready.register(new, selectors.EVENT_READ)
        self._watched = queues

    @property
    def _may_hear_strangers(self) -> bool:
        alone = self._apart is None
        return alone or self._may_hold_older or self._strangers.left(monotonic()) > 0

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

    def receive(self, timeout: float) -> bytes:
        self._next_look = 0.0  # what is there already is not to be waited for
        return super().receive(timeout)

    def _read(self) -> bytes | None:
        if self._may_hold_older and (data := self._read_older()) is not None:
            return data
        if self._apart is not None:
            data = self._read_from(self._apart, LARGEST_HEARD)
            if data is not None or not self._is_strangers_turn():
                return data
        return self._read_of_all()

    def _read_older(self) -> bytes | None:
        """What came before the peer had its queue, in the order in which it came: later it would
        pass for a repetition. Strangers among it get no more than their ration."""
        data = self._read_of_all() if self._strangers.left(monotonic()) > 0 else None
        self._may_hold_older = data is not None
        return data

    def _read_of_all(self) -> bytes | None:
        data = self._read_from(self._socket, STRANGERS_DATAGRAM)
        if data is not None and self.sender != self.peer:
            self._strangers.take(len(data))
        return data

    def _is_strangers_turn(self) -> bool:
        """Not at each look, or the peer's next datagram would be found later."""
        now = monotonic()
        if now < self._next_look:
            return False
        self._next_look = now + STRANGERS_EVERY
        return self._strangers.left(now) > 0

    def _read_from(self, queue: socket.socket, size: int) -> bytes | None:
        try:
            data, self.sender = queue.recvfrom(LARGEST_HEARD)
        except (BlockingIOError, *NOBODY_THERE):
            return None
        return data[:size]

    def accept_peer(self) -> None:
        if self.sender != self.peer:
            self._end_queue()
            self.peer = self.sender
            self._apart = queue_for(self.peer, self._socket)
            self._may_hold_older = self._apart is not None

    def leave_peer(self) -> None:
        self._end_queue()
        self.peer = None

    def _end_queue(self) -> None:
        self._watch(set())
        self._may_hold_older = False
        if self._apart is not None:
            self._apart.close()
            self._apart = None

    def close(self) -> None:
        self._end_queue()
        self._ready.close()
        super().close()


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
        for _ in range(2):
            try:
                self._socket.send(data)
            except BlockingIOError:
                return  # no room: lost, as on any way
            except NOBODY_THERE:
                continue  # an earlier one found nobody, and this one was not sent
            except OSError as error:
                raise _cannot("send to", self.name, error) from error
            return

    def _read(self) -> bytes | None:
        try:
            return self._socket.recv(LARGEST_HEARD)
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
    if isinstance(error, PermissionError) and what == "bind":
        return NoSuchPortError(f"cannot {what} {name}: not permitted: take a port above 1023")
    if error.errno == errno.EADDRINUSE:
        return PortBusyError(
            f"cannot {what} {name}: the port is in use: end the other program or take another port"
        )
    return NoSuchPortError(f"cannot {what} {name}: {error.strerror}: check host and port")
