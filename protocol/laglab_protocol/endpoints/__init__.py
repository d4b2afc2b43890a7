"""Where bytes come from and go to. Endpoints know no MAVLink."""

from laglab_protocol.endpoints.interface import Address, Endpoint, Link
from laglab_protocol.endpoints.pair import SerialPair
from laglab_protocol.endpoints.terminals import require_terminals
from laglab_protocol.endpoints.url import open_endpoint
from laglab_protocol.endpoints.wire import BITS_PER_BYTE

__all__ = [
    "BITS_PER_BYTE",
    "Address",
    "Endpoint",
    "Link",
    "SerialPair",
    "open_endpoint",
    "require_terminals",
]
