"""The robot's services as one: verified frames in, messages out. No I/O, no clock of its own."""

from laglab_gateway.services.asker import Asker
from laglab_gateway.services.commands import Commands
from laglab_gateway.services.pace import Pace
from laglab_gateway.services.parameters import Parameters
from laglab_gateway.services.state import Arming, RobotState
from laglab_gateway.services.telemetry import REPORTS
from laglab_gateway.services.timesync import Timesyncing
from laglab_protocol import ROBOT_COMPONENT, ROBOT_SYSTEM, Frame, Message, Ping, Timesync

ANYBODY = 0


class Services:
    """The rover that ground stations see. Clocks are compared only if there is a `timesync`."""

    def __init__(
        self,
        parameters: Parameters,
        armed: bool = True,
        timesync: Timesyncing | None = None,
        placeable: bool = True,
    ) -> None:
        self.parameters = parameters
        self.arming = Arming(armed, placeable)
        self.timesync = timesync
        self._state = RobotState(0, 0.0, 0.0, 0.0, 0.0, 0.0)
        self._commands = Commands(self.arming, self._report)

    def answer(
        self, frame: Frame, state: RobotState, asker: Asker | None = None, trusted: bool = True
    ) -> list[Message]:
        """What to say to this frame, nothing to most, while the robot is in this state.

        As much as the asker may be told. One who is not `trusted` may see, arm and stop.
        """
        asker = asker or Asker()
        if not asker.is_worth_asking(frame):
            return []
        self._state = state
        return asker.granted(self._answers(frame, asker.pace, trusted))

    def _answers(self, frame: Frame, pace: Pace | None, trusted: bool) -> list[Message]:
        message = frame.message
        if isinstance(message, Timesync):
            return self.timesync.answer(message) if self.timesync else []
        if isinstance(message, Ping):
            return _pong(frame, message)
        if not _for_the_robot(message):
            return []
        return [
            *self.parameters.answer(frame, trusted),
            *self._commands.answer(frame, pace, trusted),
        ]

    def due(self, pace: Pace, state: RobotState, now_us: int) -> list[Message]:
        """The telemetry that it is time to send to one who watches; by any steady clock [us]."""
        return [REPORTS[number](state, self.arming) for number in pace.due(now_us)]

    def _report(self, number: int) -> Message | None:
        return REPORTS[number](self._state, self.arming) if number in REPORTS else None


def _pong(frame: Frame, message: Ping) -> list[Message]:
    if message.target_system != ANYBODY:
        return []
    return [Ping(message.time_usec, message.seq, frame.system, frame.component)]


def _for_the_robot(message: Message) -> bool:
    system = getattr(message, "target_system", None)
    component = getattr(message, "target_component", None)
    return system in (ANYBODY, ROBOT_SYSTEM) and component in (ANYBODY, ROBOT_COMPONENT)
