"""What runs here: its version, and which of MAVLink's protocols it speaks."""

import re
from functools import cache
from importlib.metadata import version

from laglab_protocol import AutopilotVersion
from laglab_protocol.dialect.generated import laglab as mavlink

MATURITY: dict[str | None, int] = {
    ".dev": mavlink.FIRMWARE_VERSION_TYPE_DEV,
    "a": mavlink.FIRMWARE_VERSION_TYPE_ALPHA,
    "b": mavlink.FIRMWARE_VERSION_TYPE_BETA,
    "rc": mavlink.FIRMWARE_VERSION_TYPE_RC,
    None: mavlink.FIRMWARE_VERSION_TYPE_OFFICIAL,
}
"""What a version's suffix (PEP 440) says of it."""
CAPABILITIES: int = (
    mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT
    | mavlink.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
    # Without these three, clients refuse by themselves to ask for lists, which are empty here.
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mavlink.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY
    | mavlink.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mavlink.MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION
    | mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
)


@cache
def autopilot_version() -> AutopilotVersion:
    """Which version of what this is."""
    ours, nothing = packed_version(version("laglab")), (0,) * 8
    return AutopilotVersion(CAPABILITIES, 0, ours, 0, 0, 0, 0, 0, nothing, nothing, nothing)


def packed_version(text: str) -> int:
    """`1.2.3rc4` as AUTOPILOT_VERSION has it: major, minor, patch and maturity, a byte each.

    Raises ValueError for what is not a version.
    """
    found = re.match(r"(\d+)(?:\.(\d+))?(?:\.(\d+))?(a|b|rc|\.dev)?", text)
    if found is None:
        raise ValueError(f"{text!r} is not a version such as 1.2.3")
    *numbers, suffix = found.groups()
    major, minor, patch = (min(int(number or 0), 255) for number in numbers)
    return major << 24 | minor << 16 | patch << 8 | MATURITY[suffix]
