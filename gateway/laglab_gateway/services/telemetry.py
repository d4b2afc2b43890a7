"""The robot's state in the standard messages and their frames.

Ours is x east, y north, theta from east towards north (ROS REP 103). MAVLink's world is north,
east, down and its body forward, right, down, so yaw is from north towards east:
north = y, east = x, yaw = pi/2 - theta, yaw rate = -omega.
"""

import math
import re
from collections.abc import Callable
from functools import cache
from importlib.metadata import version
from typing import NamedTuple

from laglab_gateway.services.state import Arming, RobotState
from laglab_protocol import (
    Attitude,
    AutopilotVersion,
    Heartbeat,
    LocalPositionNed,
    Message,
    Odometry,
    SysStatus,
    SystemTime,
)
from laglab_protocol.dialect.generated import laglab as mavlink

MAVLINK_VERSION = 3
MATURITY: dict[str | None, int] = {
    ".dev": mavlink.FIRMWARE_VERSION_TYPE_DEV,
    "a": mavlink.FIRMWARE_VERSION_TYPE_ALPHA,
    "b": mavlink.FIRMWARE_VERSION_TYPE_BETA,
    "rc": mavlink.FIRMWARE_VERSION_TYPE_RC,
    None: mavlink.FIRMWARE_VERSION_TYPE_OFFICIAL,
}
"""What a version's suffix (PEP 440) says of it."""
CAPABILITIES: int = (
    mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT
    | mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
)
UNKNOWN = (math.nan,) + (0.0,) * 20
"""A covariance that is not told."""
NO_VOLTAGE, NO_CURRENT, NO_BATTERY = 0xFFFF, -1, -1


class Ned(NamedTuple):
    """The state in MAVLink's frames: position and velocity in the world, yaw [m, m/s, rad]."""

    north: float
    east: float
    v_north: float
    v_east: float
    yaw: float
    yaw_rate: float


def to_ned(state: RobotState) -> Ned:
    """Convert; yaw is in (-pi, pi]."""
    yaw = math.pi / 2 - state.theta
    return Ned(
        north=state.y,
        east=state.x,
        v_north=state.v * math.sin(state.theta),
        v_east=state.v * math.cos(state.theta),
        yaw=math.atan2(math.sin(yaw), math.cos(yaw)),
        yaw_rate=-state.omega,
    )


def heartbeat(arming: Arming) -> Heartbeat:
    """A ground rover, and whether it may move."""
    base_mode = mavlink.MAV_MODE_FLAG_GUIDED_ENABLED
    if arming.armed:
        base_mode |= mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    if arming.stopped:
        status = mavlink.MAV_STATE_EMERGENCY
    else:
        status = mavlink.MAV_STATE_ACTIVE if arming.armed else mavlink.MAV_STATE_STANDBY
    return Heartbeat(
        custom_mode=0,
        type=mavlink.MAV_TYPE_GROUND_ROVER,
        autopilot=mavlink.MAV_AUTOPILOT_GENERIC,
        base_mode=base_mode,
        system_status=status,
        mavlink_version=MAVLINK_VERSION,
    )


def sys_status() -> SysStatus:
    """Motors and odometry are there and well; there is no battery."""
    sensors = (
        mavlink.MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS
        | mavlink.MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL
    )
    return SysStatus(sensors, sensors, sensors, 0, NO_VOLTAGE, NO_CURRENT, *(0,) * 6, NO_BATTERY)


def system_time(state: RobotState) -> SystemTime:
    """Time since the start; what day it is, a simulation does not know."""
    return SystemTime(time_unix_usec=0, time_boot_ms=_milliseconds(state))


def attitude(state: RobotState) -> Attitude:
    """Yaw alone: the robot lives in the plane."""
    ned = to_ned(state)
    return Attitude(_milliseconds(state), 0.0, 0.0, ned.yaw, 0.0, 0.0, ned.yaw_rate)


def local_position(state: RobotState) -> LocalPositionNed:
    """Position and velocity in the world."""
    ned = to_ned(state)
    return LocalPositionNed(
        _milliseconds(state), ned.north, ned.east, 0.0, ned.v_north, ned.v_east, 0.0
    )


def odometry(state: RobotState) -> Odometry:
    """Pose in the world (NED), velocity in the body (forward, right, down)."""
    ned = to_ned(state)
    return Odometry(
        time_usec=state.time_us,
        x=ned.north,
        y=ned.east,
        z=0.0,
        q=(math.cos(ned.yaw / 2), 0.0, 0.0, math.sin(ned.yaw / 2)),
        vx=state.v,
        vy=0.0,
        vz=0.0,
        rollspeed=0.0,
        pitchspeed=0.0,
        yawspeed=ned.yaw_rate,
        pose_covariance=UNKNOWN,
        velocity_covariance=UNKNOWN,
        frame_id=mavlink.MAV_FRAME_LOCAL_NED,
        child_frame_id=mavlink.MAV_FRAME_BODY_FRD,
        estimator_type=mavlink.MAV_ESTIMATOR_TYPE_NAIVE,
    )


@cache
def autopilot_version() -> AutopilotVersion:
    """Which version of what this is."""
    ours, nothing = packed_version(version("laglab")), (0,) * 8
    return AutopilotVersion(CAPABILITIES, 0, ours, 0, 0, 0, 0, 0, nothing, nothing, nothing)


def packed_version(text: str) -> int:
    """`1.2.3rc4` as AUTOPILOT_VERSION has it: major, minor, patch and maturity, a byte each.

    Raises ValueError for what is not a version.
    """
    found = re.match(r"(\d+)(?:\.(\d+))?(?:\.(\d+))?(a|b|rc|\.dev)?", text)
    if found is None:
        raise ValueError(f"{text!r} is not a version such as 1.2.3")
    *numbers, suffix = found.groups()
    major, minor, patch = (min(int(number or 0), 255) for number in numbers)
    return major << 24 | minor << 16 | patch << 8 | MATURITY[suffix]


def _milliseconds(state: RobotState) -> int:
    return state.time_us // 1000


REPORTS: dict[int, Callable[[RobotState, Arming], Message]] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: lambda _, arming: heartbeat(arming),
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: lambda _, __: sys_status(),
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: lambda state, _: system_time(state),
    mavlink.MAVLINK_MSG_ID_ATTITUDE: lambda state, _: attitude(state),
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: lambda state, _: local_position(state),
    mavlink.MAVLINK_MSG_ID_ODOMETRY: lambda state, _: odometry(state),
    mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION: lambda _, __: autopilot_version(),
}
"""Every message that may be asked for."""
