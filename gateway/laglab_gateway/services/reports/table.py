"""Every message that may be asked for, and what it is made from."""

from collections.abc import Callable
from typing import NamedTuple

from laglab_gateway.services.reports import geography, telemetry
from laglab_gateway.services.reports.geography import Origin
from laglab_gateway.services.reports.identity import autopilot_version
from laglab_gateway.services.state import Arming, RobotState
from laglab_protocol import AutopilotVersionRequest, Message, SetGpsGlobalOrigin, SetHomePosition
from laglab_protocol.dialect.generated import laglab as mavlink


class Seen(NamedTuple):
    """What there is to report of."""

    state: RobotState
    arming: Arming
    origin: Origin


REPORTS: dict[int, Callable[[Seen], Message]] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: lambda seen: telemetry.heartbeat(seen.arming),
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: lambda _: telemetry.sys_status(),
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: lambda seen: telemetry.system_time(seen.state),
    mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: lambda _: telemetry.extended_sys_state(),
    mavlink.MAVLINK_MSG_ID_ATTITUDE: lambda seen: telemetry.attitude(seen.state),
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: lambda seen: telemetry.local_position(seen.state),
    mavlink.MAVLINK_MSG_ID_ODOMETRY: lambda seen: telemetry.odometry(seen.state),
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: lambda seen: geography.global_position(
        seen.state, seen.origin
    ),
    mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: lambda seen: geography.gps(seen.state, seen.origin),
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: lambda seen: geography.home(seen.state, seen.origin),
    mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: lambda seen: geography.global_origin(
        seen.state, seen.origin
    ),
    mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION: lambda _: autopilot_version(),
}
"""What makes each message, by its id."""

REQUESTS: dict[type[Message], int] = {
    AutopilotVersionRequest: mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION,
    SetGpsGlobalOrigin: mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN,
    SetHomePosition: mavlink.MAVLINK_MSG_ID_HOME_POSITION,
}
"""What is asked for by messages of their own; who asks for another origin is told which holds."""


def report(number: int, seen: Seen) -> list[Message]:
    """The message with this id; nothing if it is none that may be asked for."""
    return [REPORTS[number](seen)] if number in REPORTS else []
