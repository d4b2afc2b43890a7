"""The messages of common.xml that a rover and its ground stations exchange, in wire order.

What they mean is told at https://mavlink.io/en/messages/common.html; units as there.
"""

from laglab_protocol.dialect.generated import laglab as mavlink
from laglab_protocol.messages.base import Message


class Heartbeat(Message, frozen=True):
    """Anybody, once a second: I am here, and of this kind."""

    custom_mode: int
    type: int
    autopilot: int
    base_mode: int
    system_status: int
    mavlink_version: int


STATION_HEARTBEAT = Heartbeat(
    custom_mode=0,
    type=mavlink.MAV_TYPE_GCS,
    autopilot=mavlink.MAV_AUTOPILOT_INVALID,
    base_mode=0,
    system_status=mavlink.MAV_STATE_ACTIVE,
    mavlink_version=3,
)
"""How a remote station makes itself known to the robot."""


class SysStatus(Message, frozen=True):
    """The robot's health: sensors as bits of MAV_SYS_STATUS_SENSOR, load in 0.1 %."""

    onboard_control_sensors_present: int
    onboard_control_sensors_enabled: int
    onboard_control_sensors_health: int
    load: int
    voltage_battery: int
    current_battery: int
    drop_rate_comm: int
    errors_comm: int
    errors_count1: int
    errors_count2: int
    errors_count3: int
    errors_count4: int
    battery_remaining: int
    onboard_control_sensors_present_extended: int = 0
    onboard_control_sensors_enabled_extended: int = 0
    onboard_control_sensors_health_extended: int = 0


class SystemTime(Message, frozen=True):
    """The sender's clocks: Unix time [us], 0 if unknown, and time since its start [ms]."""

    time_unix_usec: int
    time_boot_ms: int


class Ping(Message, frozen=True):
    """A ping, with target 0, or the answer to one, with its sender as target."""

    time_usec: int
    seq: int
    target_system: int
    target_component: int


class Timesync(Message, frozen=True):
    """Asked with tc1 = 0, ts1 = now [ns]; answered with tc1 = now there and the same ts1."""

    tc1: int
    ts1: int


class Attitude(Message, frozen=True):
    """Roll, pitch, yaw of the body (forward, right, down) against north, east, down [rad]."""

    time_boot_ms: int
    roll: float
    pitch: float
    yaw: float
    rollspeed: float
    pitchspeed: float
    yawspeed: float


class LocalPositionNed(Message, frozen=True):
    """Position [m] and velocity [m/s], north, east, down."""

    time_boot_ms: int
    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float


class Odometry(Message, frozen=True):
    """Pose in `frame_id` and velocity in `child_frame_id`, with covariances (upper triangles)."""

    time_usec: int
    x: float
    y: float
    z: float
    q: tuple[float, ...]
    vx: float
    vy: float
    vz: float
    rollspeed: float
    pitchspeed: float
    yawspeed: float
    pose_covariance: tuple[float, ...]
    velocity_covariance: tuple[float, ...]
    frame_id: int
    child_frame_id: int
    reset_counter: int = 0
    estimator_type: int = 0
    quality: int = 0


class ParamRequestRead(Message, frozen=True):
    """Asks for one parameter, by index, or by name if the index is -1."""

    param_index: int
    target_system: int
    target_component: int
    param_id: bytes


class ParamRequestList(Message, frozen=True):
    """Asks for all parameters."""

    target_system: int
    target_component: int


class ParamSet(Message, frozen=True):
    """Asks for a parameter to be set; answered with PARAM_VALUE, whatever came of it."""

    param_value: float
    target_system: int
    target_component: int
    param_id: bytes
    param_type: int


class ParamValue(Message, frozen=True):
    """The value that a parameter has."""

    param_value: float
    param_count: int
    param_index: int
    param_id: bytes
    param_type: int


class ParamError(Message, frozen=True):
    """Why a parameter was not read or set (MAV_PARAM_ERROR)."""

    param_index: int
    target_system: int
    target_component: int
    param_id: bytes
    error: int


class CommandLong(Message, frozen=True):
    """A command (MAV_CMD) with seven numbers; always answered with COMMAND_ACK."""

    param1: float
    param2: float
    param3: float
    param4: float
    param5: float
    param6: float
    param7: float
    command: int
    target_system: int
    target_component: int
    confirmation: int


class CommandInt(Message, frozen=True):
    """A command (MAV_CMD) with a position as integers; always answered with COMMAND_ACK."""

    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    command: int
    target_system: int
    target_component: int
    frame: int
    current: int
    autocontinue: int


class CommandAck(Message, frozen=True):
    """What became of a command (MAV_RESULT)."""

    command: int
    result: int
    progress: int = 0
    result_param2: int = 0
    target_system: int = 0
    target_component: int = 0


class AutopilotVersion(Message, frozen=True):
    """What runs here, and what it can do (MAV_PROTOCOL_CAPABILITY)."""

    capabilities: int
    uid: int
    flight_sw_version: int
    middleware_sw_version: int
    os_sw_version: int
    board_version: int
    vendor_id: int
    product_id: int
    flight_custom_version: tuple[int, ...]
    middleware_custom_version: tuple[int, ...]
    os_custom_version: tuple[int, ...]
    uid2: tuple[int, ...] = (0,) * 18


MAV_SEVERITY_EMERGENCY, MAV_SEVERITY_ERROR, MAV_SEVERITY_WARNING = 0, 3, 4


class Statustext(Message, frozen=True):
    """A line for a person (severity: MAV_SEVERITY), at most 50 bytes."""

    severity: int
    text: bytes
    id: int = 0
    chunk_seq: int = 0
