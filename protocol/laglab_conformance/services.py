"""The items of the services that ground stations find in a robot."""

from laglab_conformance.items import Item
from laglab_conformance.robot import RobotSession
from laglab_protocol import (
    AutopilotVersion,
    Heartbeat,
    Message,
    ParamRequestList,
    ParamRequestRead,
    ParamValue,
    Ping,
)
from laglab_protocol.dialect.generated import laglab as mavlink

NO_SUCH_COMMAND = 65_000


def _reports(number: int, kind: type[Message]) -> Item[RobotSession]:
    def check(session: RobotSession) -> str | None:
        before = len(session.heard)
        ack = session.order(mavlink.MAV_CMD_REQUEST_MESSAGE, float(number))
        if ack.result != mavlink.MAV_RESULT_ACCEPTED:
            return f"refused with MAV_RESULT {ack.result}"
        # It may have come together with the acknowledgement.
        if session.told(kind, before) or session.wait_for(kind, session.waits.react):
            return None
        return f"accepted, but no {kind.__name__} came"

    return Item("services", f"it reports {kind.__name__} on request", check, mandatory=False)


def _acknowledges(session: RobotSession) -> str | None:
    ack = session.order(NO_SUCH_COMMAND)
    expected = mavlink.MAV_RESULT_UNSUPPORTED
    return None if ack.result == expected else f"answered with MAV_RESULT {ack.result}"


def _acknowledges_us(session: RobotSession) -> str | None:
    """Or nobody by name: older senders leave both out."""
    ack = session.order(NO_SUCH_COMMAND)
    target = ack.target_system, ack.target_component
    us = session.system, session.component
    meant = all(told in (0, own) for told, own in zip(target, us, strict=True))
    return None if meant else f"it is meant for {target}, {us} asked"


def _lists_parameters(session: RobotSession) -> str | None:
    first = session.ask(ParamRequestList(*session.peer), ParamValue)
    session.quiet()
    came = {each.param_index for each in session.told(ParamValue)}
    missing = set(range(first.param_count)) - came
    return f"{len(missing)} of {first.param_count} did not come" if missing else None


def _reads_parameters(session: RobotSession) -> str | None:
    by_index = session.ask(ParamRequestRead(0, *session.peer, b""), ParamValue)
    by_name = session.ask(ParamRequestRead(-1, *session.peer, by_index.param_id), ParamValue)
    return None if by_name == by_index else f"{by_index} by index, {by_name} by name"


def _answers_ping(session: RobotSession) -> str | None:
    session.send(Ping(123, 7, 0, 0))
    answer = Ping(123, 7, session.system, session.component)
    found = session.listen(session.waits.react, lambda frame: frame.message == answer)
    return None if found else "no answer"


SERVICES: list[Item[RobotSession]] = [
    Item("services", "an unknown command is acknowledged as such", _acknowledges),
    Item("services", "an acknowledgement is meant for who asked", _acknowledges_us),
    _reports(mavlink.MAVLINK_MSG_ID_HEARTBEAT, Heartbeat),
    _reports(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION, AutopilotVersion),
    Item("services", "it lists its parameters", _lists_parameters, mandatory=False),
    Item("services", "it reads a parameter by index and name", _reads_parameters, mandatory=False),
    Item("services", "it answers a ping", _answers_ping, mandatory=False),
]
