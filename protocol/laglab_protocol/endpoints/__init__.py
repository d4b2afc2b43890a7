"""Where bytes come from and go to. Endpoints know no MAVLink."""

from laglab_protocol.endpoints.interface import Endpoint
from laglab_protocol.endpoints.pair import SerialPair
from laglab_protocol.endpoints.url import open_endpoint

__all__ = ["Endpoint", "SerialPair", "open_endpoint"]
