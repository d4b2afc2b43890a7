"""What a person at the station must not overlook."""

from laglab_protocol import (
    BEGUN_AGAIN,
    MAV_SEVERITY_EMERGENCY,
    MAV_SEVERITY_ERROR,
    Statustext,
)

MOST_TOLD = 20
"""At most so many texts of the robot's are kept: it may say whatever it likes."""


class Warnings:
    """Warnings by what they are about: of each the first."""

    def __init__(self) -> None:
        self._texts: dict[str, str] = {}
        self._told = 0
        self.emergency_tick: int | None = None
        """The tick by which somebody had stopped the robot for good, the first time."""

    def add(self, about: str, text: str) -> None:
        """Put a warning on record, unless there is one about this already."""
        self._texts.setdefault(about, text)

    def met(self, tick: int, last: int | None) -> None:
        """A robot at `tick` that is new, behind the one that said `last`."""
        if last is not None and tick <= last:
            self.add(BEGUN_AGAIN, BEGUN_AGAIN)

    def hear(self, told: Statustext, tick: int) -> None:
        """What the robot itself says after its `tick`, if it is worse than a warning."""
        if told.severity == MAV_SEVERITY_EMERGENCY and self.emergency_tick is None:
            self.emergency_tick = tick
        text = told.text.decode(errors="replace")
        if told.severity > MAV_SEVERITY_ERROR or text in self._texts or self._told >= MOST_TOLD:
            return
        self._told += 1
        self.add(text, f"the robot says: {text}")

    @property
    def texts(self) -> tuple[str, ...]:
        """In the order in which they were found."""
        return tuple(self._texts.values())
