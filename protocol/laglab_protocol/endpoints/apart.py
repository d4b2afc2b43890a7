"""A queue for one peer of a UDP port, apart from everybody else's.

The system gives a datagram to the socket that is connected to whoever sent it, before one that
hears all. So strangers, however many datagrams they send, fill a queue of their own.
"""

import os
import socket
from typing import Any


def queue_for(peer: Any, shared: socket.socket) -> socket.socket | None:
    """A socket at the address of `shared` for what `peer` sends; None where the system refuses."""
    if os.name != "posix":
        return None  # on Windows the leave to share an address is one to take it over
    apart = socket.socket(shared.family, socket.SOCK_DGRAM)
    apart.setblocking(False)
    try:
        _let_share(True, shared, apart)
        apart.bind(shared.getsockname())
        apart.connect(peer)
        # Nobody else may bind the address: the leave is taken back.
        _let_share(False, shared, apart)
    except OSError:
        apart.close()
        _let_share(False, shared)
        return None
    return apart


def _let_share(leave: bool, *sockets: socket.socket) -> None:
    for each in sockets:
        each.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, leave)
