"""Missions, fences and rally points: three lists that are, and stay, empty."""

from laglab_protocol import (
    Frame,
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionCurrent,
    MissionItem,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionRequestPartialList,
    MissionSetCurrent,
    MissionWritePartialList,
)
from laglab_protocol.dialect.generated import laglab as mavlink

NONE_CURRENT = MissionCurrent(0, 0, mavlink.MISSION_STATE_NO_MISSION)


def about_missions(frame: Frame) -> list[Message]:
    """What to say to a request about a list; nothing to anything else."""
    asker = frame.system, frame.component
    match frame.message:
        case MissionRequestList(mission_type=kind):
            return [MissionCount(0, *asker, kind)]
        case MissionSetCurrent():
            return [NONE_CURRENT]
        case MissionClearAll(mission_type=kind) | MissionCount(count=0, mission_type=kind):
            result = mavlink.MAV_MISSION_ACCEPTED
        case MissionCount(mission_type=kind):
            result = mavlink.MAV_MISSION_NO_SPACE
        case (
            MissionRequestPartialList(mission_type=kind)
            | MissionWritePartialList(mission_type=kind)
        ):
            result = mavlink.MAV_MISSION_UNSUPPORTED
        case (
            MissionRequest(mission_type=kind)
            | MissionRequestInt(mission_type=kind)
            | MissionItem(mission_type=kind)
            | MissionItemInt(mission_type=kind)
        ):
            result = mavlink.MAV_MISSION_INVALID_SEQUENCE
        case _:
            return []
    return [MissionAck(*asker, result, kind)]
