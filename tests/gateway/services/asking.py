"""Asking the rover's services, frame by frame: no socket, no clock."""

from laglab_gateway import Services
from laglab_gateway.services import RobotState
from laglab_protocol import CommandAck, CommandLong, Frame, Message
from laglab_protocol.dialect.generated import laglab as mavlink

STATE = RobotState(1_500_000, 3.0, 4.0, 0.0, 2.0, 0.5)
GCS = (255, 190)
REAL32 = mavlink.MAV_PARAM_TYPE_REAL32
ARM, STOP, RESET = 400, 185, mavlink.MAV_CMD_LAGLAB_RESET_POSE


def frame(message: Message, sender: tuple[int, int] = GCS) -> Frame:
    return Frame(message, *sender, 0, b"")


def ask(services: Services, message: Message) -> list[Message]:
    return services.answer(frame(message), STATE)


def command(number: int, *numbers: float, target: tuple[int, int] = (1, 1)) -> CommandLong:
    padded = (*numbers, *[0.0] * (7 - len(numbers)))
    return CommandLong(*padded, number, *target, 0)


def result(services: Services, number: int, *numbers: float) -> int:
    ack, *_ = ask(services, command(number, *numbers))
    assert isinstance(ack, CommandAck)
    assert (ack.command, ack.target_system, ack.target_component) == (number, *GCS)
    return ack.result
