"""A scenario's origin reaches the ground stations that look on."""

from laglab.runs.robot_side import Setup, open_robot
from laglab.scenario import load
from laglab_gateway.services import RobotState
from laglab_protocol import CommandLong, Frame, GpsGlobalOrigin
from laglab_protocol.dialect.generated import laglab as mavlink

ASKED = CommandLong(
    *[float(mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN), *[0.0] * 6],
    command=mavlink.MAV_CMD_REQUEST_MESSAGE,
    target_system=1,
    target_component=1,
    confirmation=0,
)


def test_the_origin_of_the_scenario_is_told() -> None:
    place = {"origin.latitude": 47.4, "origin.longitude": 8.5, "origin.altitude": 440.0}
    with open_robot(load("fig6", place), Setup()) as robot:
        state = RobotState(0, 0.0, 0.0, 0.0, 0.0, 0.0)
        _, told = robot.services.answer(Frame(ASKED, 255, 190, 0, b""), state)
    assert told == GpsGlobalOrigin(474_000_000, 85_000_000, 440_000, 0)
