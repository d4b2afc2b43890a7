"""Where on Earth the robot is: its plane, laid at an origin, for the maps of ground stations."""

import math
from typing import Annotated, NamedTuple

from pydantic import Field

from laglab_gateway.services.reports.frames import to_ned
from laglab_gateway.services.state import RobotState
from laglab_gateway.values import Number, checked, described
from laglab_protocol import GlobalPositionInt, GpsGlobalOrigin, GpsRawInt, HomePosition
from laglab_protocol.dialect.generated import laglab as mavlink

SEMI_MAJOR_AXIS = 6_378_137.0
"""a of WGS 84 [m]"""
ECCENTRICITY_SQUARED = 6.69437999014e-3
"""e² of WGS 84"""

NO_POSITION = 2**31 - 1
UNKNOWN, UNKNOWN_COUNT = 2**16 - 1, 2**8 - 1
FASTEST = 2**15 - 1
"""[cm/s] What fits into the messages."""


class Point(NamedTuple):
    """As messages have it: 1e-7 degrees, NO_POSITION for what is not finite."""

    latitude: int
    longitude: int


@checked
class Origin:
    """Where on Earth x = y = 0 lies: there a ground station's map shows the robot."""

    latitude: Annotated[
        Number, Field(ge=-89, le=89), described("deg", "Latitude, WGS 84, positive in the north.")
    ] = 21.038
    longitude: Annotated[
        Number, Field(ge=-180, le=180), described("deg", "Longitude, WGS 84, positive in the east.")
    ] = 105.782
    altitude: Annotated[
        Number, Field(ge=-1000, le=10000), described("m", "Height above mean sea level.")
    ] = 10.0

    @property
    def altitude_mm(self) -> int:
        """As messages have it."""
        return round(self.altitude * 1000)

    def at(self, north: float, east: float) -> Point:
        """The point so far [m] from the origin, along the ellipsoid's two radii of curvature
        there: M in the meridian, N across it."""
        latitude = math.radians(self.latitude)
        bulge = 1 - ECCENTRICITY_SQUARED * math.sin(latitude) ** 2
        N = SEMI_MAJOR_AXIS / math.sqrt(bulge)
        M = N * (1 - ECCENTRICITY_SQUARED) / bulge
        up = north / (M + self.altitude)
        along = east / ((N + self.altitude) * math.cos(latitude))
        return Point(
            _e7(self.latitude + math.degrees(up)), _e7(self.longitude + math.degrees(along))
        )


SOMEWHERE = Origin()
"""Unless somebody names another place: a robot on a map must be somewhere."""


def global_position(state: RobotState, origin: Origin) -> GlobalPositionInt:
    """Where it is, how fast, and where its nose points."""
    ned = to_ned(state)
    point = origin.at(ned.north, ned.east)
    return GlobalPositionInt(
        time_boot_ms=state.time_ms,
        lat=point.latitude,
        lon=point.longitude,
        alt=origin.altitude_mm,
        relative_alt=0,
        vx=_centi(ned.v_north),
        vy=_centi(ned.v_east),
        vz=0,
        hdg=_bearing(ned.yaw),
    )


def gps(state: RobotState, origin: Origin) -> GpsRawInt:
    """The same as a satellite receiver would say it, its accuracy unknown."""
    ned = to_ned(state)
    point = origin.at(ned.north, ned.east)
    return GpsRawInt(
        time_usec=state.time_us,
        lat=point.latitude,
        lon=point.longitude,
        alt=origin.altitude_mm,
        eph=UNKNOWN,
        epv=UNKNOWN,
        vel=abs(_centi(state.v)),
        cog=_bearing(math.atan2(ned.v_east, ned.v_north)),
        fix_type=mavlink.GPS_FIX_TYPE_3D_FIX,
        satellites_visible=UNKNOWN_COUNT,
    )


def home(state: RobotState, origin: Origin) -> HomePosition:
    """The origin."""
    return HomePosition(
        *origin.at(0.0, 0.0),
        altitude=origin.altitude_mm,
        x=0.0,
        y=0.0,
        z=0.0,
        q=(1.0, 0.0, 0.0, 0.0),
        approach_x=0.0,
        approach_y=0.0,
        approach_z=0.0,
        time_usec=state.time_us,
    )


def global_origin(state: RobotState, origin: Origin) -> GpsGlobalOrigin:
    """The origin."""
    return GpsGlobalOrigin(*origin.at(0.0, 0.0), origin.altitude_mm, state.time_us)


def _e7(degrees: float) -> int:
    """Around the Earth, in 1e-7 degrees."""
    return round(math.remainder(degrees, 360) * 1e7) if math.isfinite(degrees) else NO_POSITION


def _centi(speed: float) -> int:
    """[m/s] in cm/s, as far as it fits."""
    return round(max(-FASTEST, min(speed * 100, FASTEST))) if math.isfinite(speed) else 0


def _bearing(angle: float) -> int:
    """From north towards east [rad], in 0.01 degrees from 0 on."""
    return round(math.degrees(angle) * 100) % 36000 if math.isfinite(angle) else UNKNOWN
