"""What the services know of the robot, and whether it may move."""

from typing import NamedTuple


class RobotState(NamedTuple):
    """The robot at one tick: time since its start [us], pose [m, m, rad], speeds [m/s, rad/s]."""

    time_us: int
    x: float
    y: float
    theta: float
    v: float
    omega: float

    @property
    def time_ms(self) -> int:
        """The same time in whole milliseconds."""
        return self.time_us // 1000


Pose = tuple[float, float, float]
"""x, y, theta [m, m, rad]; NaN stands for the start pose's coordinate."""


class Arming:
    """Whether the robot may move. An emergency stop latches until the pose is reset; where the
    robot is real, and so not `placeable`, it latches for good."""

    def __init__(self, armed: bool, placeable: bool = True) -> None:
        self.armed = armed
        self._placeable = placeable
        self.stopped = False
        self.stops = 0
        """Emergency stops so far."""
        self.reset_to: Pose | None = None

    def arm(self) -> bool:
        """Let it move; False when an emergency stop is latched."""
        self.armed = not self.stopped
        return self.armed

    def disarm(self) -> None:
        """From now on it stands still."""
        self.armed = False

    def stop(self) -> None:
        """Stand still at once, and stay so."""
        self.armed = False
        self.stops += not self.stopped
        self.stopped = True

    def reset(self, pose: Pose) -> bool:
        """Ask for the robot to be put at `pose`; False while it may move."""
        if self.armed or not self._placeable:
            return False
        self.stopped = False
        self.reset_to = pose
        return True

    def take_reset(self) -> Pose | None:
        """The pose asked for since the last call; who calls puts the robot there."""
        pose, self.reset_to = self.reset_to, None
        return pose
