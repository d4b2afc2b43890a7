"""Who speaks, and to whom: the two that matter to the loop."""

from laglab_protocol import (
    ROBOT,
    STATION,
    Command,
    Frame,
    Plan,
    Recall,
)


def from_station(frame: Frame) -> bool:
    """Whether the remote station sent it: nobody else may command."""
    return (frame.system, frame.component) == STATION


def from_robot(frame: Frame) -> bool:
    """Whether the robot itself sent it."""
    return (frame.system, frame.component) == ROBOT


def is_for_robot(message: Command | Plan | Recall) -> bool:
    """Whether it is meant for the robot, and not for another one on the same line."""
    target = message.target_system, message.target_component
    return target == ROBOT
