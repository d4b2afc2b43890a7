"""What can go wrong here, as one tree. What comes over the link never raises: it is passed over."""


class StationError(Exception):
    """Any error of this component."""


class RobotSilentError(StationError):
    """The robot was heard, and then no more."""
