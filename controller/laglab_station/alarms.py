"""The alarms of a run: for the report, and for those who watch."""

from laglab_control import Control, Controller
from laglab_protocol import MAV_SEVERITY_WARNING, Message, Statustext
from laglab_station.report import Alarm

ESTIMATE_IS_WRONG = "estimate is wrong"
"""How what is said of an alarm begins."""
TOLD = 100
"""The report tells of so many; the rest are only counted."""


class Alarms:
    """Over all controllers of a station, one after the other."""

    def __init__(self) -> None:
        self.told: list[Alarm] = []
        self.raised = 0
        self._gated = 0
        """Measurements that the controllers before this one did not use."""

    def note(self, controller: Controller, control: Control, tick: int) -> list[Message]:
        """What is to be said of this tick."""
        alarm = controller.alarm(control)
        if alarm is None:
            return []
        self.raised += 1
        if len(self.told) < TOLD:
            self.told.append(Alarm(tick, alarm.cause))
        text = f"{ESTIMATE_IS_WRONG} at tick {tick}: locating"
        return [Statustext(MAV_SEVERITY_WARNING, text.encode())]

    def gated(self, controller: Controller, control: Control) -> int:
        """Measurements that were too wild to be used."""
        return self._gated + controller.gated(control)

    def handed_over(self, controller: Controller, control: Control) -> None:
        """This controller's work is over."""
        self._gated += controller.gated(control)
