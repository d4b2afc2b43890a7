"""Modes. There is one, in which the remote station drives, and heartbeats show it."""

from laglab_gateway.services.results import ACCEPTED, DENIED
from laglab_protocol.dialect.generated import laglab as mavlink

MODE: int = mavlink.MAV_MODE_FLAG_GUIDED_ENABLED
ARMED: int = mavlink.MAV_MODE_FLAG_SAFETY_ARMED
CUSTOM_MODE = 0


def set_mode(base_mode: float, custom_mode: float) -> int:
    """What becomes of the wish for a mode (MAV_RESULT): the one that there is, is in force.

    Whether it is armed is not a matter of the mode, by MAVLink's rule: the flag is passed over.
    """
    wished = base_mode - ARMED if base_mode >= ARMED else base_mode
    return ACCEPTED if (wished, custom_mode) == (MODE, CUSTOM_MODE) else DENIED
