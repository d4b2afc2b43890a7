"""What the robot does not have is refused, or empty; nothing is met with silence."""

from laglab_gateway import Services
from laglab_protocol import (
    DataStream,
    FileTransferProtocol,
    LogData,
    LogEntry,
    LogRequestData,
    LogRequestList,
    ParamExtAck,
    ParamExtRequestList,
    ParamExtRequestRead,
    ParamExtSet,
    ParamExtValue,
    RequestDataStream,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import GCS, ask

CUSTOM = mavlink.MAV_PARAM_EXT_TYPE_CUSTOM


def test_there_are_no_logs(services: Services) -> None:
    assert ask(services, LogRequestList(0, 65535, 1, 1)) == [LogEntry(0, 0, 0, 0, 0)]
    assert ask(services, LogRequestData(90, 90, 3, 1, 1)) == [LogData(90, 3, 0, (0,) * 90)]


def test_there_are_no_extended_parameters(services: Services) -> None:
    assert ask(services, ParamExtRequestList(1, 1)) == [ParamExtValue(0, 65535, b"", b"", CUSTOM)]
    assert ask(services, ParamExtRequestRead(-1, 1, 1, b"CAM")) == [
        ParamExtAck(b"CAM", b"", CUSTOM, mavlink.PARAM_ACK_FAILED)
    ]
    assert ask(services, ParamExtSet(1, 1, b"CAM", b"1", CUSTOM)) == [
        ParamExtAck(b"CAM", b"1", CUSTOM, mavlink.PARAM_ACK_VALUE_UNSUPPORTED)
    ]


def test_a_stream_is_off(services: Services) -> None:
    asked = RequestDataStream(4, 1, 1, mavlink.MAV_DATA_STREAM_POSITION, 1)
    assert ask(services, asked) == [DataStream(0, mavlink.MAV_DATA_STREAM_POSITION, 0)]


def test_files_are_refused(services: Services) -> None:
    """The answer's number is one on, it names what was asked for, and why not."""
    session, path = 7, b"/"
    head = (0xFF, 0x01, session, mavlink.MAV_FTP_OPCODE_LISTDIRECTORY, len(path), 0, 0, 0)
    asked = (*head, 1, 2, 3, 4, *path)
    (answer,) = ask(services, FileTransferProtocol(0, 1, 1, asked + (0,) * (251 - len(asked))))

    assert isinstance(answer, FileTransferProtocol)
    assert (answer.target_system, answer.target_component) == GCS
    assert len(answer.payload) == 251
    assert answer.payload[:13] == (
        *(0x00, 0x02, session, mavlink.MAV_FTP_OPCODE_NAK, 1),
        *(mavlink.MAV_FTP_OPCODE_LISTDIRECTORY, 0, 0),
        *(1, 2, 3, 4, mavlink.MAV_FTP_ERR_UNKNOWNCOMMAND),
    )
