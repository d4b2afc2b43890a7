"""The robot's state in the standard messages."""

import math

from laglab_gateway.services.modes import ARMED, CUSTOM_MODE, MODE
from laglab_gateway.services.reports.frames import to_ned
from laglab_gateway.services.state import Arming, RobotState
from laglab_protocol import (
    Attitude,
    ExtendedSysState,
    Heartbeat,
    LocalPositionNed,
    Odometry,
    SysStatus,
    SystemTime,
)
from laglab_protocol.dialect.generated import laglab as mavlink

MAVLINK_VERSION = 3
SENSORS: int = (
    mavlink.MAV_SYS_STATUS_SENSOR_GPS
    | mavlink.MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS
    | mavlink.MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL
)
HEALTHY: int = SENSORS | mavlink.MAV_SYS_STATUS_GEOFENCE
"""There is no fence: it cannot be breached, which ground stations read from its health alone."""
UNKNOWN = (math.nan,) + (0.0,) * 20
"""A covariance that is not told."""
NO_VOLTAGE, NO_CURRENT, NO_BATTERY = 0xFFFF, -1, -1


def heartbeat(arming: Arming) -> Heartbeat:
    """A ground rover, and whether it may move."""
    if arming.stopped:
        status = mavlink.MAV_STATE_EMERGENCY
    else:
        status = mavlink.MAV_STATE_ACTIVE if arming.armed else mavlink.MAV_STATE_STANDBY
    return Heartbeat(
        custom_mode=CUSTOM_MODE,
        type=mavlink.MAV_TYPE_GROUND_ROVER,
        autopilot=mavlink.MAV_AUTOPILOT_GENERIC,
        base_mode=MODE | ARMED if arming.armed else MODE,
        system_status=status,
        mavlink_version=MAVLINK_VERSION,
    )


def sys_status() -> SysStatus:
    """Motors and odometry are there and well; there is no battery."""
    power = NO_VOLTAGE, NO_CURRENT
    return SysStatus(SENSORS, SENSORS, HEALTHY, 0, *power, *(0,) * 6, NO_BATTERY)


def extended_sys_state() -> ExtendedSysState:
    """It does not fly."""
    return ExtendedSysState(mavlink.MAV_VTOL_STATE_UNDEFINED, mavlink.MAV_LANDED_STATE_ON_GROUND)


def system_time(state: RobotState) -> SystemTime:
    """Time since the start; what day it is, a simulation does not know."""
    return SystemTime(time_unix_usec=0, time_boot_ms=state.time_ms)


def attitude(state: RobotState) -> Attitude:
    """Yaw alone: the robot lives in the plane."""
    ned = to_ned(state)
    return Attitude(state.time_ms, 0.0, 0.0, ned.yaw, 0.0, 0.0, ned.yaw_rate)


def local_position(state: RobotState) -> LocalPositionNed:
    """Position and velocity in the world."""
    ned = to_ned(state)
    return LocalPositionNed(state.time_ms, ned.north, ned.east, 0.0, ned.v_north, ned.v_east, 0.0)


def odometry(state: RobotState) -> Odometry:
    """Pose in the world (NED), velocity in the body (forward, right, down).

    MAV_FRAME_BODY_NED means just that, the one for positions and the other for velocities; of the
    frames that do, it alone is known to mavsdk.
    """
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
        frame_id=mavlink.MAV_FRAME_BODY_NED,
        child_frame_id=mavlink.MAV_FRAME_BODY_NED,
        estimator_type=mavlink.MAV_ESTIMATOR_TYPE_NAIVE,
    )
