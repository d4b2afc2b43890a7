"""What can go wrong here, as one tree. What comes over the link never raises: it is passed over."""


class StationError(Exception):
    """Any error of this component."""


class ConfigError(StationError):
    """A value that the station or a model is given is not as it must be; the message names it."""


class StampError(StationError):
    """A measurement says that it was sampled before tick 0, or in the future."""


class RobotSilentError(StationError):
    """The robot was heard, and then no more."""
