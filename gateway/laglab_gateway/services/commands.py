"""Commands (MAV_CMD): every one that is meant for the robot is acknowledged."""

import math
from collections.abc import Callable

from msgspec.structs import astuple

from laglab_gateway.services.pace import Pace
from laglab_gateway.services.state import Arming
from laglab_gateway.services.telemetry import REPORTS
from laglab_protocol import CommandAck, CommandInt, CommandLong, Frame, Message
from laglab_protocol.dialect.generated import laglab as mavlink

ACCEPTED: int = mavlink.MAV_RESULT_ACCEPTED
REJECTED_FOR_NOW: int = mavlink.MAV_RESULT_TEMPORARILY_REJECTED
DENIED: int = mavlink.MAV_RESULT_DENIED
UNSUPPORTED: int = mavlink.MAV_RESULT_UNSUPPORTED

Numbers = tuple[float, ...]
"""param1 to param7; of COMMAND_INT the first four."""
Result = tuple[int, list[Message]]
"""MAV_RESULT, and what to say after the acknowledgement."""


SEE_ARM_AND_STOP = {
    mavlink.MAV_CMD_COMPONENT_ARM_DISARM,
    mavlink.MAV_CMD_DO_FLIGHTTERMINATION,
    mavlink.MAV_CMD_REQUEST_MESSAGE,
    mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES,
}
"""What those may who need no key where others have one."""


class Commands:
    """Carries commands out. `report(id)` gives the message with this id, None if it has none."""

    def __init__(
        self,
        arming: Arming,
        report: Callable[[int], Message | None],
    ) -> None:
        self._arming = arming
        self._report = report
        self._handlers: dict[int, Callable[[Numbers], Result]] = {
            mavlink.MAV_CMD_COMPONENT_ARM_DISARM: self._arm_or_disarm,
            mavlink.MAV_CMD_DO_FLIGHTTERMINATION: self._emergency_stop,
            mavlink.MAV_CMD_LAGLAB_RESET_POSE: self._reset_pose,
            mavlink.MAV_CMD_REQUEST_MESSAGE: self._request_message,
            mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: self._capabilities,
        }

    def answer(self, frame: Frame, pace: Pace | None, trusted: bool) -> list[Message]:
        """The acknowledgement, and what the command asked to be told. `pace` is the asker's, who
        may be denied what only the `trusted` may."""
        message = frame.message
        if not isinstance(message, CommandLong | CommandInt):
            return []
        numbers = astuple(message)[: 7 if isinstance(message, CommandLong) else 4]
        result, more = self._carry_out(message.command, numbers, pace, trusted)
        ack = CommandAck(message.command, result, 0, 0, frame.system, frame.component)
        return [ack, *more]

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
        message = self._report(_message_id(numbers[0]))
        return (UNSUPPORTED, []) if message is None else (ACCEPTED, [message])

    def _capabilities(self, numbers: Numbers) -> Result:
        del numbers
        return self._request_message((float(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION),))


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
