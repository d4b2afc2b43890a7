"""What can go wrong in the mathematics, as one tree."""


class ControlError(Exception):
    """Any error of this component."""


class ConfigError(ControlError, ValueError):
    """A value that a model, a law or a controller is given is not as it must be; the message names
    it."""


class StampError(ControlError):
    """A measurement says that it was sampled before tick 0, or in the future."""


class PluginError(ControlError):
    """What was named cannot be had, or does not do what it must; the text names it."""


class PluginFailedError(PluginError):
    """It failed while it ran, or answered what it must not."""
