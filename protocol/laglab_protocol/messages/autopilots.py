"""The messages about what autopilots have: files, logs, modes, streams; in wire order.

Of common.xml: what they mean is told at https://mavlink.io/en/messages/common.html.
"""

from laglab_protocol.messages.base import Message


class SetMode(Message, frozen=True):
    """Asks for a mode (MAV_MODE_FLAG and an autopilot's own number)."""

    custom_mode: int
    target_system: int
    base_mode: int


class ExtendedSysState(Message, frozen=True):
    """Whether it flies (MAV_LANDED_STATE), and how (MAV_VTOL_STATE)."""

    vtol_state: int
    landed_state: int


class AutopilotVersionRequest(Message, frozen=True):
    """Asks for AUTOPILOT_VERSION, as older programs do; of ardupilotmega.xml."""

    target_system: int
    target_component: int


class RequestDataStream(Message, frozen=True):
    """Asks for a group of messages (MAV_DATA_STREAM) so many times a second."""

    req_message_rate: int
    target_system: int
    target_component: int
    req_stream_id: int
    start_stop: int


class DataStream(Message, frozen=True):
    """Whether such a group is sent, and how often."""

    message_rate: int
    stream_id: int
    on_off: int


class FileTransferProtocol(Message, frozen=True):
    """A request about files, or the answer (https://mavlink.io/en/services/ftp.html)."""

    target_network: int
    target_system: int
    target_component: int
    payload: tuple[int, ...]


class LogRequestList(Message, frozen=True):
    """Asks which logs there are, from one number to another; answered with LOG_ENTRY."""

    start: int
    end: int
    target_system: int
    target_component: int


class LogEntry(Message, frozen=True):
    """One log, and how many there are."""

    time_utc: int
    size: int
    id: int
    num_logs: int
    last_log_num: int


class LogRequestData(Message, frozen=True):
    """Asks for a part of a log; answered with LOG_DATA."""

    ofs: int
    count: int
    id: int
    target_system: int
    target_component: int


class LogData(Message, frozen=True):
    """Bytes of a log; none, at its end."""

    ofs: int
    id: int
    count: int
    data: tuple[int, ...]


class ParamExtRequestRead(Message, frozen=True):
    """Asks for one extended parameter, by index, or by name if the index is -1."""

    param_index: int
    target_system: int
    target_component: int
    param_id: bytes


class ParamExtRequestList(Message, frozen=True):
    """Asks for all extended parameters; answered with PARAM_EXT_VALUE."""

    target_system: int
    target_component: int


class ParamExtValue(Message, frozen=True):
    """An extended parameter, and how many there are."""

    param_count: int
    param_index: int
    param_id: bytes
    param_value: bytes
    param_type: int


class ParamExtSet(Message, frozen=True):
    """Asks for an extended parameter to be set; answered with PARAM_EXT_ACK."""

    target_system: int
    target_component: int
    param_id: bytes
    param_value: bytes
    param_type: int


class ParamExtAck(Message, frozen=True):
    """What became of a request about an extended parameter (PARAM_ACK)."""

    param_id: bytes
    param_value: bytes
    param_type: int
    param_result: int
