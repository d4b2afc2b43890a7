"""The robot's services as one: verified frames in, messages out. No I/O, no clock of its own."""

from laglab_gateway.services.commands import Commands
from laglab_gateway.services.parameters import Parameters
from laglab_gateway.services.state import Arming, RobotState
from laglab_gateway.services.telemetry import REPORTS
from laglab_gateway.services.timesync import Timesyncing
from laglab_protocol import ROBOT_COMPONENT, ROBOT_SYSTEM, Frame, Message, Ping, Timesync
from laglab_protocol.dialect.generated import laglab as mavlink

ANYBODY = 0
SECOND_US = 1_000_000

INTERVALS_US: dict[int, int] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: SECOND_US,
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: SECOND_US,
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: SECOND_US,
    mavlink.MAVLINK_MSG_ID_ATTITUDE: SECOND_US // 10,
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: SECOND_US // 10,
    mavlink.MAVLINK_MSG_ID_ODOMETRY: SECOND_US // 10,
}
"""How often each is sent to those who watch, until they say otherwise; the others never."""

NEVER, AS_USUAL = -1, 0
SHORTEST_INTERVAL_US = SECOND_US // 100


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
        self._commands = Commands(self.arming, self._report, self._set_interval)
        self._intervals = dict(INTERVALS_US)
        self._sent_at: dict[int, int] = {}

    def answer(self, frame: Frame, state: RobotState) -> list[Message]:
        """What to say to this frame, nothing to most, while the robot is in this state."""
        self._state, message = state, frame.message
        if isinstance(message, Timesync):
            return self.timesync.answer(message) if self.timesync else []
        if isinstance(message, Ping):
            return _pong(frame, message)
        if not _for_the_robot(message):
            return []
        return self.parameters.answer(frame) + self._commands.answer(frame)

    def due(self, state: RobotState, now_us: int) -> list[Message]:
        """The telemetry that it is time to send to those who watch; by any steady clock [us]."""
        messages = []
        for number, interval_us in self._intervals.items():
            if interval_us > 0 and now_us - self._sent_at.get(number, -SECOND_US) >= interval_us:
                self._sent_at[number] = now_us
                messages.append(REPORTS[number](state, self.arming))
        return messages

    def _report(self, number: int) -> Message | None:
        return REPORTS[number](self._state, self.arming) if number in REPORTS else None

    def _set_interval(self, number: int, interval_us: float) -> bool:
        if number not in REPORTS:
            return False
        usual = INTERVALS_US.get(number, NEVER)
        if interval_us == AS_USUAL:
            self._intervals[number] = usual
        elif interval_us == NEVER:
            self._intervals[number] = NEVER
        else:
            self._intervals[number] = max(int(interval_us), SHORTEST_INTERVAL_US)
        return True


def _pong(frame: Frame, message: Ping) -> list[Message]:
    if message.target_system != ANYBODY:
        return []
    return [Ping(message.time_usec, message.seq, frame.system, frame.component)]


def _for_the_robot(message: Message) -> bool:
    system = getattr(message, "target_system", None)
    component = getattr(message, "target_component", None)
    return system in (ANYBODY, ROBOT_SYSTEM) and component in (ANYBODY, ROBOT_COMPONENT)
