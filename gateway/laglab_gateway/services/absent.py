"""What other autopilots have and this robot does not: files, logs, extended parameters, streams.

Who asks for it is told so: silence would make a ground station wait, and ask again.
"""

from laglab_protocol import (
    DataStream,
    FileTransferProtocol,
    Frame,
    LogData,
    LogEntry,
    LogRequestData,
    LogRequestList,
    Message,
    ParamExtAck,
    ParamExtRequestList,
    ParamExtRequestRead,
    ParamExtSet,
    ParamExtValue,
    RequestDataStream,
)
from laglab_protocol.dialect.generated import laglab as mavlink

NO_LOG = LogEntry(time_utc=0, size=0, id=0, num_logs=0, last_log_num=0)
LOG_DATA_SIZE = 90
NO_INDEX = 2**16 - 1
CUSTOM: int = mavlink.MAV_PARAM_EXT_TYPE_CUSTOM
NO_PARAMETERS = ParamExtValue(0, NO_INDEX, b"", b"", CUSTOM)

FTP_SIZE = 251
FTP_ERROR_SIZE = 1


def about_absent(frame: Frame) -> list[Message]:
    """The refusal, or the empty answer; nothing to anything else."""
    match frame.message:
        case FileTransferProtocol(payload=payload):
            return [FileTransferProtocol(0, frame.system, frame.component, _refused(payload))]
        case LogRequestList():
            return [NO_LOG]
        case LogRequestData(ofs=start, id=number):
            return [LogData(start, number, 0, (0,) * LOG_DATA_SIZE)]
        case ParamExtRequestList():
            return [NO_PARAMETERS]
        case ParamExtRequestRead(param_id=name):
            return [ParamExtAck(name, b"", CUSTOM, mavlink.PARAM_ACK_FAILED)]
        case ParamExtSet(param_id=name, param_value=value, param_type=kind):
            return [ParamExtAck(name, value, kind, mavlink.PARAM_ACK_VALUE_UNSUPPORTED)]
        case RequestDataStream(req_stream_id=stream):
            return [DataStream(message_rate=0, stream_id=stream, on_off=0)]
    return []


def _refused(request: tuple[int, ...]) -> tuple[int, ...]:
    """The payload of a NAK: sequence number (one on), session, opcode, size, the opcode refused,
    two bytes of nothing, offset, and from byte 12 on why."""
    sequence = (request[0] + (request[1] << 8) + 1) & 0xFFFF
    _, _, session, opcode, *_ = request
    head = (sequence & 0xFF, sequence >> 8, session, mavlink.MAV_FTP_OPCODE_NAK, FTP_ERROR_SIZE)
    whole = (*head, opcode, 0, 0, *request[8:12], mavlink.MAV_FTP_ERR_UNKNOWNCOMMAND)
    return whole + (0,) * (FTP_SIZE - len(whole))
