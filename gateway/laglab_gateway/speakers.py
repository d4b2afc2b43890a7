"""Who speaks, and to whom: the two that matter to the loop."""

from laglab_protocol import (
    ROBOT_COMPONENT,
    ROBOT_SYSTEM,
    STATION_COMPONENT,
    STATION_SYSTEM,
    Command,
    Frame,
    Plan,
    Recall,
)


def from_station(frame: Frame) -> bool:
    """Whether the remote station sent it: nobody else may command."""
    return (frame.system, frame.component) == (STATION_SYSTEM, STATION_COMPONENT)


def from_robot(frame: Frame) -> bool:
    """Whether the robot itself sent it."""
    return (frame.system, frame.component) == (ROBOT_SYSTEM, ROBOT_COMPONENT)


def is_for_robot(message: Command | Plan | Recall) -> bool:
    """Whether it is meant for the robot, and not for another one on the same line."""
    target = message.target_system, message.target_component
    return target == (ROBOT_SYSTEM, ROBOT_COMPONENT)
