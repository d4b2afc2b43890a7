"""Where on Earth the robot is."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import ConfigError, Origin, Safety, Services, standard_parameters
from laglab_gateway.services import RobotState
from laglab_gateway.services.reports.geography import NO_POSITION
from laglab_protocol import (
    GlobalPositionInt,
    GpsGlobalOrigin,
    GpsRawInt,
    HomePosition,
    Message,
    Sender,
    SetGpsGlobalOrigin,
    SetHomePosition,
)
from laglab_protocol.dialect.generated import laglab as mavlink

from .asking import command, frame

BERN = Origin(46.95, 7.45, 540.0)
STATE = RobotState(1_500_000, 300.0, 400.0, math.pi / 4, 2.0, 0.5)
"""300 m east, 400 m north, towards the north-east."""


def told(message: Message, state: RobotState = STATE, origin: Origin = BERN) -> Message:
    services = Services(standard_parameters(0, 0, Safety()), origin=origin)
    *_, answer = services.answer(frame(message), state)
    return answer


@pytest.mark.parametrize(
    ("latitude", "metres_north", "metres_east"),
    [(0.0, 110_574, 111_320), (45.0, 111_132, 78_847), (60.0, 111_412, 55_800)],
)
def test_a_degree_is_as_long_as_on_the_ellipsoid(
    latitude: float, metres_north: float, metres_east: float
) -> None:
    """Lengths as tables of WGS 84 have them, in a small step."""
    point = Origin(latitude, 10.0, 0.0).at(metres_north / 100, metres_east / 100)
    assert point.latitude * 1e-7 == pytest.approx(latitude + 0.01, abs=2e-7)
    assert point.longitude * 1e-7 == pytest.approx(10.01, abs=2e-7)


def test_the_robot_is_on_the_map() -> None:
    position = told(command(512, mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT))
    assert isinstance(position, GlobalPositionInt)
    assert position.lat * 1e-7 == pytest.approx(46.95 + 400 / 111_170, abs=1e-5)
    assert position.lon * 1e-7 == pytest.approx(7.45 + 300 / 76_130, abs=1e-5)
    assert (position.alt, position.relative_alt, position.time_boot_ms) == (540_000, 0, 1500)
    assert (position.vx, position.vy, position.hdg) == (141, 141, 4500)

    gps = told(command(512, mavlink.MAVLINK_MSG_ID_GPS_RAW_INT))
    assert isinstance(gps, GpsRawInt)
    assert (gps.lat, gps.lon, gps.alt) == (position.lat, position.lon, position.alt)
    assert (gps.fix_type, gps.vel, gps.cog) == (mavlink.GPS_FIX_TYPE_3D_FIX, 200, 4500)


def test_backwards_its_course_is_not_its_heading() -> None:
    state = STATE._replace(v=-2.0)
    gps = told(command(512, mavlink.MAVLINK_MSG_ID_GPS_RAW_INT), state)
    position = told(command(512, mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT), state)
    assert isinstance(gps, GpsRawInt)
    assert isinstance(position, GlobalPositionInt)
    assert (gps.vel, gps.cog, position.hdg) == (200, 22500, 4500)


@pytest.mark.parametrize("number", [512.0, 410.0])
def test_home_is_the_origin(number: int) -> None:
    told_home = told(command(int(number), mavlink.MAVLINK_MSG_ID_HOME_POSITION))
    assert isinstance(told_home, HomePosition)
    assert (told_home.latitude, told_home.longitude) == (469_500_000, 74_500_000)
    assert (told_home.altitude, told_home.x, told_home.y) == (540_000, 0.0, 0.0)


def test_who_asks_for_another_origin_or_home_is_told_which_holds() -> None:
    origin = told(SetGpsGlobalOrigin(1, 2, 3, 1))
    assert origin == GpsGlobalOrigin(469_500_000, 74_500_000, 540_000, 1_500_000)
    home = told(SetHomePosition(1, 2, 3, *[0.0] * 3, (1.0, 0.0, 0.0, 0.0), *[0.0] * 3, 1))
    assert isinstance(home, HomePosition)
    assert home.latitude == 469_500_000


def test_around_the_earth_the_longitude_goes_on() -> None:
    assert Origin(0.0, 180.0, 0.0).at(0.0, 111.32).longitude == pytest.approx(-1_799_990_000, abs=9)


@pytest.mark.parametrize(
    "values", [(90.0, 0.0, 0.0), (0.0, 181.0, 0.0), (0.0, 0.0, 1e5), (math.nan, 0.0, 0.0)]
)
def test_what_is_no_place_is_refused(values: tuple[float, float, float]) -> None:
    with pytest.raises(ConfigError, match=r"^(latitude|longitude|altitude): must be"):
        Origin(*values)


def test_what_is_nowhere_has_no_position() -> None:
    assert BERN.at(math.nan, math.inf) == (NO_POSITION, NO_POSITION)


ANY = st.floats()


@given(
    st.builds(RobotState, st.integers(0, 2**40), ANY, ANY, st.floats(-1e9, 1e9), ANY, ANY),
    st.builds(Origin, st.floats(-89, 89), st.floats(-180, 180), st.floats(-1000, 10000)),
)
def test_whatever_the_state_it_can_be_sent(state: RobotState, origin: Origin) -> None:
    for number in (
        mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT,
        mavlink.MAVLINK_MSG_ID_GPS_RAW_INT,
        mavlink.MAVLINK_MSG_ID_HOME_POSITION,
    ):
        Sender(1, 1).frame(told(command(512, number), state, origin))
