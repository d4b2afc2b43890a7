"""Commands (MAV_CMD): every one that is meant for the robot is acknowledged."""

import math
from collections.abc import Callable

from msgspec.structs import astuple

from laglab_gateway.services.modes import set_mode
from laglab_gateway.services.pace import Pace
from laglab_gateway.services.reports import REPORTS
from laglab_gateway.services.results import ACCEPTED, DENIED, REJECTED_FOR_NOW, UNSUPPORTED
from laglab_gateway.services.state import Arming
from laglab_protocol import CommandAck, CommandInt, CommandLong, Frame, Message, SetMode
from laglab_protocol.dialect.generated import laglab as mavlink

Numbers = tuple[float, ...]
"""param1 to param7; of COMMAND_INT the first four."""
Result = tuple[int, list[Message]]
"""MAV_RESULT, and what to say after the acknowledgement."""


SEE_ARM_AND_STOP = {
    mavlink.MAV_CMD_COMPONENT_ARM_DISARM,
    mavlink.MAV_CMD_DO_FLIGHTTERMINATION,
    mavlink.MAV_CMD_REQUEST_MESSAGE,
    mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES,
    mavlink.MAV_CMD_GET_HOME_POSITION,
    mavlink.MAV_CMD_DO_SET_MODE,  # there is one mode, so it changes nothing
}
"""What one may ask without a key where others have one."""


class Commands:
    """Carries commands out. `report(id)` gives the message with this id, in a list, if any."""

    def __init__(
        self,
        arming: Arming,
        report: Callable[[int], list[Message]],
    ) -> None:
        self._arming = arming
        self._report = report
        self._handlers: dict[int, Callable[[Numbers], Result]] = {
            mavlink.MAV_CMD_COMPONENT_ARM_DISARM: self._arm_or_disarm,
            mavlink.MAV_CMD_DO_FLIGHTTERMINATION: self._emergency_stop,
            mavlink.MAV_CMD_LAGLAB_RESET_POSE: self._reset_pose,
            mavlink.MAV_CMD_REQUEST_MESSAGE: self._request_message,
            mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: self._capabilities,
            mavlink.MAV_CMD_GET_HOME_POSITION: self._home_position,
            mavlink.MAV_CMD_DO_SET_MODE: _set_mode,
        }

    def answer(self, frame: Frame, pace: Pace | None, trusted: bool) -> list[Message]:
        """The acknowledgement, and what the command asked to be told. `pace` is the asker's; unless
        it is `trusted`, it may only see, arm and stop."""
        if (asked := _command_in(frame.message)) is None:
            return []
        command, numbers = asked
        result, more = self._carry_out(command, numbers, pace, trusted)
        return [CommandAck(command, result, 0, 0, frame.system, frame.component), *more]

    def _carry_out(
        self, command: int, numbers: Numbers, pace: Pace | None, trusted: bool
    ) -> Result:
        if command == mavlink.MAV_CMD_SET_MESSAGE_INTERVAL:
            return _set_interval(numbers, pace), []
        handler = self._handlers.get(command)
        if handler is None:
            return UNSUPPORTED, []
        return handler(numbers) if trusted or command in SEE_ARM_AND_STOP else (DENIED, [])

    def _arm_or_disarm(self, numbers: Numbers) -> Result:
        if numbers[0] == 1.0:
            return (ACCEPTED if self._arming.arm() else REJECTED_FOR_NOW), []
        if numbers[0] == 0.0:
            self._arming.disarm()
            return ACCEPTED, []
        return DENIED, []

    def _emergency_stop(self, numbers: Numbers) -> Result:
        if not numbers[0] > 0.5:
            return DENIED, []
        self._arming.stop()
        return ACCEPTED, []

    def _reset_pose(self, numbers: Numbers) -> Result:
        if len(numbers) < 3 or any(map(math.isinf, numbers[:3])):
            return DENIED, []
        done = self._arming.reset((numbers[0], numbers[1], numbers[2]))
        return (ACCEPTED if done else REJECTED_FOR_NOW), []

    def _request_message(self, numbers: Numbers) -> Result:
        return self._told(_message_id(numbers[0]))

    def _capabilities(self, _: Numbers) -> Result:
        return self._told(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)

    def _home_position(self, _: Numbers) -> Result:
        return self._told(mavlink.MAVLINK_MSG_ID_HOME_POSITION)

    def _told(self, number: int) -> Result:
        told = self._report(number)
        return (ACCEPTED if told else UNSUPPORTED), told


def _command_in(message: Message) -> tuple[int, Numbers] | None:
    """Which command it is, and its numbers; None when it is none."""
    match message:
        case CommandLong():
            return message.command, astuple(message)[:7]
        case CommandInt():
            return message.command, astuple(message)[:4]
        case SetMode(custom_mode=custom_mode, base_mode=base_mode):
            return mavlink.MAV_CMD_DO_SET_MODE, (base_mode, custom_mode)
    return None


def _set_mode(numbers: Numbers) -> Result:
    return set_mode(numbers[0], numbers[1]), []


def _set_interval(numbers: Numbers, pace: Pace | None) -> int:
    number, interval = _message_id(numbers[0]), numbers[1]
    if not (math.isfinite(interval) and interval >= -1):
        return DENIED
    if pace is None or number not in REPORTS:
        return UNSUPPORTED
    pace.set(number, interval)
    return ACCEPTED


def _message_id(number: float) -> int:
    return int(number) if math.isfinite(number) else -1
