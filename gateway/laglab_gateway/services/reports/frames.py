"""Our frames, and MAVLink's.

Ours is x east, y north, theta from east towards north (ROS REP 103). MAVLink's world is north,
east, down and its body forward, right, down, so yaw is from north towards east:
north = y, east = x, yaw = pi/2 - theta, yaw rate = -omega.
"""

import math
from typing import NamedTuple

from laglab_gateway.services.state import RobotState


class Ned(NamedTuple):
    """The state in MAVLink's frames: position and velocity in the world, yaw and its
    rate [m, m/s, rad, rad/s]."""

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
