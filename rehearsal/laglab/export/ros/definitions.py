"""The definitions of the messages, which go into the file: a reader needs no ROS."""

import re

from laglab_gateway import FateKind

DEFINITIONS = {
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec",
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Quaternion": "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1",
    "geometry_msgs/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
    "geometry_msgs/PoseStamped": "std_msgs/Header header\ngeometry_msgs/Pose pose",
    "geometry_msgs/PoseWithCovariance": "geometry_msgs/Pose pose\nfloat64[36] covariance",
    "geometry_msgs/Twist": "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular",
    "geometry_msgs/TwistStamped": "std_msgs/Header header\ngeometry_msgs/Twist twist",
    "geometry_msgs/TwistWithCovariance": "geometry_msgs/Twist twist\nfloat64[36] covariance",
    "geometry_msgs/Transform": (
        "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation"
    ),
    "geometry_msgs/TransformStamped": (
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform"
    ),
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    "nav_msgs/Odometry": (
        "std_msgs/Header header\n"
        "string child_frame_id\n"
        "geometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist"
    ),
    "laglab_msgs/LinkEvent": (
        "# What the link did to one copy of a frame\n"
        "std_msgs/Header header  # when the frame entered\n"
        "int32 tick              # in which it entered\n"
        "uint32 frame            # its number in that tick\n"
        "uint32 copy             # which copy of it\n"
        "uint32 size             # bytes\n"
        f"string fate             # {', '.join(FateKind)}\n"
        "float64 extra           # how much later than the fixed delay, s"
    ),
    "laglab_msgs/Arrival": (
        "# A message that came out of the link\n"
        "std_msgs/Header header  # when it came\n"
        "int32 tick              # that it is stamped with\n"
        "int32 arrived           # the tick at which it came\n"
        "int32 delay             # the one less the other, ticks\n"
        "string refused          # why the robot did not follow the command, or no"
    ),
}
"""Those of ROS as they are in ROS 2 since Foxy, and two of ours."""

BETWEEN = "\n" + "=" * 80 + "\n"
_NESTED = re.compile(r"^(\w+/\w+)", re.MULTILINE)


def whole_definition(name: str) -> str:
    """Of `package/Message`, with all that it is made of."""
    parts = [f"MSG: {each}\n{DEFINITIONS[each]}" for each in _needed(name)[1:]]
    return BETWEEN.join([DEFINITIONS[name], *parts]) + "\n"


def _needed(name: str) -> list[str]:
    """It, and what it is made of, each once."""
    found = [name]
    for each in found:  # which grows meanwhile
        found += [other for other in _NESTED.findall(DEFINITIONS[each]) if other not in found]
    return found
