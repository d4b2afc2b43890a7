"""The robot's services as one: verified frames in, messages out. No I/O, no clock of its own."""

from laglab_gateway.services.absent import about_absent
from laglab_gateway.services.asker import Asker
from laglab_gateway.services.commands import Commands
from laglab_gateway.services.missions import about_missions
from laglab_gateway.services.pace import Pace
from laglab_gateway.services.parameters import ParameterTable
from laglab_gateway.services.reports import REQUESTS, SOMEWHERE, Origin, Seen, report
from laglab_gateway.services.state import Arming, RobotState
from laglab_gateway.services.timesync import Timesyncing
from laglab_protocol import ROBOT_COMPONENT, ROBOT_SYSTEM, Frame, Message, Ping, Timesync

ANYBODY = 0


class Services:
    """The rover that ground stations see. Clocks are compared only if there is a `timesync`."""

    def __init__(
        self,
        parameters: ParameterTable,
        armed: bool = True,
        timesync: Timesyncing | None = None,
        placeable: bool = True,
        origin: Origin = SOMEWHERE,
    ) -> None:
        self.parameters = parameters
        self.arming = Arming(armed, placeable)
        self.timesync = timesync
        self._origin = origin
        self._seen = self._seeing(RobotState(0, 0.0, 0.0, 0.0, 0.0, 0.0))
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
        self._seen = self._seeing(state)
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
            *self._report(REQUESTS.get(type(message), -1)),
            *about_missions(frame),
            *about_absent(frame),
        ]

    def due(self, pace: Pace, state: RobotState, now_us: int) -> list[Message]:
        """The telemetry that it is time to send to one who watches; by any steady clock [us]."""
        seen = self._seeing(state)
        return [message for number in pace.due(now_us) for message in report(number, seen)]

    def _seeing(self, state: RobotState) -> Seen:
        return Seen(state, self.arming, self._origin)

    def _report(self, number: int) -> list[Message]:
        return report(number, self._seen)


def _pong(frame: Frame, message: Ping) -> list[Message]:
    if message.target_system != ANYBODY:
        return []
    return [Ping(message.time_usec, message.seq, frame.system, frame.component)]


def _for_the_robot(message: Message) -> bool:
    """Some messages name a system alone; those that name none are meant for nobody."""
    system = getattr(message, "target_system", None)
    component = getattr(message, "target_component", ANYBODY)
    return system in (ANYBODY, ROBOT_SYSTEM) and component in (ANYBODY, ROBOT_COMPONENT)
