"""Why a robot stops, or does not begin to drive, although commands come."""

from laglab_gateway.drive import Rejection

SAID = {
    Rejection.NOT_FINITE: "commands are not finite: stopping",
    Rejection.OUT_OF_LIMITS: "commands are beyond V_MAX, OMEGA_MAX: stopping",
}
"""In at most 50 characters."""


class Stopping:
    """What was refused since the last command that was followed, and whether that was said."""

    def __init__(self) -> None:
        self._refused: Rejection | None = None
        self._told = set[Rejection]()

    @property
    def by_itself(self) -> bool:
        """Whether a robot that stops has nothing to say of the commands that came."""
        return self._refused is None

    def refused(self, why: Rejection) -> None:
        """Of commands that came too late nobody need hear: newer ones are followed."""
        if why in SAID:
            self._refused = why

    def followed(self) -> None:
        """A command came into force."""
        self._refused = None
        self._told.clear()

    def news(self) -> str | None:
        """What is to be said once nothing has come into force for so long that the robot stops:
        each reason once."""
        why = self._refused
        if why is None or why in self._told:
            return None
        self._told.add(why)
        return SAID[why]
