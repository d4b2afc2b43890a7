"""What can go wrong on the robot's side of the link."""


class GatewayError(Exception):
    """Base of every error the gateway raises; the message says what to do."""


class ConfigError(GatewayError, ValueError):
    """A value that the robot's side is given is not as it must be; the message names it."""


class StationSilentError(GatewayError):
    """The remote station stopped answering (or never spoke)."""

    def __init__(self, tick: int | None, seconds: float) -> None:
        self.tick = tick
        since = "never spoke" if tick is None else f"has been silent since tick {tick}"
        super().__init__(
            f"the controller {since} ({seconds:.1f} s): is it still running, and on this link?"
        )


class PlantSilentError(GatewayError):
    """A real robot, which has a clock of its own, stopped ticking (or never began)."""

    def __init__(self, link: str, tick: int | None, seconds: float) -> None:
        since = "never spoke" if tick is None else f"has been silent since its tick {tick}"
        super().__init__(
            f"{link}: the robot {since} ({seconds:.1f} s): is it switched on, and on this link; "
            "does it speak the laglab dialect at this baud, signed as --plant-key says?"
        )


class PlantWaitsError(GatewayError):
    """A real robot repeats its tick until it is answered: it has no clock of its own."""

    def __init__(self, link: str, tick: int, seconds: float) -> None:
        super().__init__(
            f"{link}: the robot has repeated its tick {tick} for {seconds:.1f} s: it waits for "
            "each command, in lock-step: give it a clock of its own (a gateway: --pace realtime)"
        )


class TraceError(GatewayError):
    """A trace file cannot be written or is not a trace."""


class TimelineError(GatewayError):
    """A timeline or link log cannot be read or believed."""


class UnplaceableError(GatewayError):
    """A robot that nobody can put elsewhere from here."""
