"""What can go wrong on the robot's side of the link."""


class GatewayError(Exception):
    """Base of every error the gateway raises; the message says what to do."""


class StationSilentError(GatewayError):
    """The remote station stopped answering (or never spoke)."""

    def __init__(self, tick: int | None, seconds: float) -> None:
        self.tick = tick
        since = "never spoke" if tick is None else f"has been silent since tick {tick}"
        super().__init__(
            f"the controller {since} ({seconds:.1f} s): is it still running, and on this link?"
        )


class CommandError(GatewayError):
    """The station sent a command that no robot can follow."""

    def __init__(self, tick: int, v: float, omega: float) -> None:
        self.tick = tick
        super().__init__(
            f"the controller's command at tick {tick} is not finite (v = {v}, omega = {omega}): "
            "the robot was not moved; look at the estimate in the trace before it"
        )


class TraceError(GatewayError):
    """A trace file cannot be written or is not a trace."""
