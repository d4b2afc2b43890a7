"""The link: the dialect's messages, their frames, and the endpoints they travel between."""

from laglab_protocol.endpoints import Endpoint, open_endpoint
from laglab_protocol.errors import (
    BadUrlError,
    DialectError,
    EndpointError,
    FarEndGoneError,
    FarEndStalledError,
    KeyFileError,
    NoSuchPortError,
    PortBusyError,
    ProtocolError,
    UnsignedLinkError,
)
from laglab_protocol.frame import Frame, Refusal
from laglab_protocol.keys import Codec, make_key, read_key, refuse_open_door
from laglab_protocol.messages import (
    NO_COMMAND,
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    End,
    EndReason,
    Estimate,
    Heartbeat,
    Measurement,
    Message,
    Tick,
    message_type,
)
from laglab_protocol.receiver import Counters, Receiver
from laglab_protocol.sender import Sender
from laglab_protocol.tlog import TlogError, read_tlog, tlog_record

__all__ = [
    "NO_COMMAND",
    "ROBOT_COMPONENT",
    "ROBOT_SYSTEM",
    "STATION_COMPONENT",
    "STATION_SYSTEM",
    "BadUrlError",
    "Codec",
    "Command",
    "Counters",
    "DialectError",
    "End",
    "EndReason",
    "Endpoint",
    "EndpointError",
    "Estimate",
    "FarEndGoneError",
    "FarEndStalledError",
    "Frame",
    "Heartbeat",
    "KeyFileError",
    "Measurement",
    "Message",
    "NoSuchPortError",
    "PortBusyError",
    "ProtocolError",
    "Receiver",
    "Refusal",
    "Sender",
    "Tick",
    "TlogError",
    "UnsignedLinkError",
    "make_key",
    "message_type",
    "open_endpoint",
    "read_key",
    "read_tlog",
    "refuse_open_door",
    "tlog_record",
]
