"""The messages of common.xml that say where on Earth a robot is, in wire order.

Latitudes and longitudes are in 1e-7 degrees, altitudes in mm above mean sea level; what the other
fields mean is told at https://mavlink.io/en/messages/common.html.
"""

from laglab_protocol.messages.base import Message


class GlobalPositionInt(Message, frozen=True):
    """Position, velocity north, east, down [cm/s] and heading [0.01 deg]."""

    time_boot_ms: int
    lat: int
    lon: int
    alt: int
    relative_alt: int
    vx: int
    vy: int
    vz: int
    hdg: int


class GpsRawInt(Message, frozen=True):
    """What a satellite receiver says: fix (GPS_FIX_TYPE), speed [cm/s] and course [0.01 deg]."""

    time_usec: int
    lat: int
    lon: int
    alt: int
    eph: int
    epv: int
    vel: int
    cog: int
    fix_type: int
    satellites_visible: int
    alt_ellipsoid: int = 0
    h_acc: int = 0
    v_acc: int = 0
    vel_acc: int = 0
    hdg_acc: int = 0
    yaw: int = 0


class GpsGlobalOrigin(Message, frozen=True):
    """Where the local frame has its origin."""

    latitude: int
    longitude: int
    altitude: int
    time_usec: int = 0


class SetGpsGlobalOrigin(Message, frozen=True):
    """Asks for another origin; answered with GPS_GLOBAL_ORIGIN, whatever came of it."""

    latitude: int
    longitude: int
    altitude: int
    target_system: int
    time_usec: int = 0


class HomePosition(Message, frozen=True):
    """Where home is, on Earth and in the local frame [m], and how to approach it."""

    latitude: int
    longitude: int
    altitude: int
    x: float
    y: float
    z: float
    q: tuple[float, ...]
    approach_x: float
    approach_y: float
    approach_z: float
    time_usec: int = 0


class SetHomePosition(Message, frozen=True):
    """Asks for another home; answered with HOME_POSITION, whatever came of it."""

    latitude: int
    longitude: int
    altitude: int
    x: float
    y: float
    z: float
    q: tuple[float, ...]
    approach_x: float
    approach_y: float
    approach_z: float
    target_system: int
    time_usec: int = 0
