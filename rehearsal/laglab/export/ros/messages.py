"""Poses, covariances and speeds in the plane as ROS has them in space."""

import math

Message = dict[str, object]
Numbers = tuple[float, ...]
"""x, y, θ of a pose [m, m, rad]; v, ω of speeds [m/s, rad/s]."""

WORLD = "world"
EXACT = (0.0,) * 6
UNKNOWN = (-1.0, *EXACT[1:])
"""Upper triangles of covariances of x, y, θ. In ROS a −1 in front says that it is not known; its
viewers drop a whole message that has a NaN."""
AT_REST = (0.0, 0.0)
PLACES = ((0,), (1, 6), (5, 30), (7,), (11, 31), (35,))
"""The places of xx, xy, xθ, yy, yθ, θθ in ROS's 6 × 6, whose rows are x, y, z, roll, pitch, yaw."""


def header(time: int, frame: str = WORLD) -> Message:
    """`time` in nanoseconds since the run's first tick."""
    seconds, nanoseconds = divmod(time, 1_000_000_000)
    return {"stamp": {"sec": seconds, "nanosec": nanoseconds}, "frame_id": frame}


def pose_stamped(time: int, at: Numbers) -> Message:
    """geometry_msgs/PoseStamped."""
    return {"header": header(time), "pose": _pose(at)}


def odometry(
    time: int, robot: str, at: Numbers, covariance: Numbers | None, speeds: Numbers | None
) -> Message:
    """nav_msgs/Odometry of the frame `robot`; `covariance` by its upper triangle. The speeds are
    those commanded: nobody says how far the robot's own are off."""
    return {
        "header": header(time),
        "child_frame_id": robot,
        "pose": {"pose": _pose(at), "covariance": _in_space(covariance or UNKNOWN)},
        "twist": {"twist": _twist(*(speeds or AT_REST)), "covariance": _in_space(UNKNOWN)},
    }


def twist_stamped(time: int, robot: str, speeds: Numbers) -> Message:
    """geometry_msgs/TwistStamped."""
    return {"header": header(time, robot), "twist": _twist(*speeds)}


def transform(time: int, robot: str, at: Numbers) -> Message:
    """tf2_msgs/TFMessage: where the frame `robot` is in the world."""
    x, y, theta = at
    moved = {"translation": _vector(x, y), "rotation": _rotation(theta)}
    one = {"header": header(time), "child_frame_id": robot, "transform": moved}
    return {"transforms": [one]}


def _pose(at: Numbers) -> Message:
    x, y, theta = at
    return {"position": _vector(x, y), "orientation": _rotation(theta)}


def _vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Message:
    return {"x": x, "y": y, "z": z}


def _rotation(theta: float) -> Message:
    return {"x": 0.0, "y": 0.0, "z": math.sin(theta / 2), "w": math.cos(theta / 2)}


def _twist(v: float, omega: float) -> Message:
    return {"linear": _vector(v), "angular": _vector(z=omega)}


def _in_space(upper: Numbers) -> list[float]:
    whole = [0.0] * 36
    for value, places in zip(upper, PLACES, strict=True):
        for place in places:
            whole[place] = value
    return whole
