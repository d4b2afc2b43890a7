"""The one table of the robot's variables.

Both model descriptions and the C header of value references are made from it. A variable's value
reference is its place in the table, and its name, with `der(x)` read as `der_x`, is the name of its
field in the C struct `Robot`.
"""

from dataclasses import dataclass
from enum import Enum

MODEL_NAME = "Robot"


class Kind(Enum):
    """The FMI type of a variable; the values are FMI 3.0's names."""

    FLOAT64 = "Float64"
    INT32 = "Int32"
    UINT64 = "UInt64"
    BOOLEAN = "Boolean"
    ENUMERATION = "Enumeration"


class Role(Enum):
    TIME = "time"
    ROBOTS = "robots"
    PARAMETER = "parameter"
    INPUT = "input"
    STATE = "state"
    SAMPLED = "sampled"
    ALGEBRAIC = "algebraic"
    DERIVATIVE = "derivative"


@dataclass(frozen=True)
class Unit:
    """A unit in powers of SI base units, and one to show it in: (name, how many make one)."""

    name: str
    powers: tuple[tuple[str, int], ...]
    display: tuple[str, float] | None = None


@dataclass(frozen=True)
class DeclaredType:
    name: str
    quantity: str
    unit: str
    description: str


@dataclass(frozen=True)
class Variable:
    name: str
    role: Role
    description: str
    declared_type: str = ""
    start: float = 0.0
    minimum: float | None = None
    maximum: float | None = None
    nominal: float | None = None
    kind: Kind = Kind.FLOAT64
    state: str = ""
    """of a derivative: the state"""
    depends_on: tuple[str, ...] = ()
    """of an unknown: the inputs and states it depends on"""

    @property
    def field(self) -> str:
        return self.name.replace("(", "_").replace(")", "")


DEGREE = 180 / 3.141592653589793

UNITS = (
    Unit("m", (("m", 1),), ("mm", 1000.0)),
    Unit("s", (("s", 1),), ("ms", 1000.0)),
    Unit("rad", (("rad", 1),), ("deg", DEGREE)),
    Unit("m/s", (("m", 1), ("s", -1)), ("km/h", 3.6)),
    Unit("rad/s", (("rad", 1), ("s", -1)), ("rev/min", 60 * DEGREE / 360)),
    Unit("m2", (("m", 2),), ("cm2", 1e4)),
    Unit("rad2", (("rad", 2),), ("deg2", DEGREE**2)),
    Unit("rad2/s2", (("rad", 2), ("s", -2)), ("deg2/s2", DEGREE**2)),
    Unit("1", (), ("%", 100.0)),
)

TYPES = (
    DeclaredType("Position", "Length", "m", "Coordinate in the plane"),
    DeclaredType("Length", "Length", "m", "Dimension of the robot"),
    DeclaredType(
        "Heading", "Angle", "rad", "Direction, counter-clockwise from the x axis, not wrapped"
    ),
    DeclaredType("Speed", "Velocity", "m/s", "Speed along the heading"),
    DeclaredType("AngularSpeed", "AngularVelocity", "rad/s", "Speed of a turn, counter-clockwise"),
    DeclaredType("Duration", "Time", "s", "Length of time"),
    DeclaredType("PositionVariance", "Area", "m2", "Variance of a position"),
    DeclaredType("HeadingVariance", "AngleVariance", "rad2", "Variance of a heading"),
    DeclaredType(
        "SpeedVariance", "AngularVelocityVariance", "rad2/s2", "Variance of a wheel speed"
    ),
    DeclaredType("Ratio", "DimensionlessRatio", "1", "Part of a whole"),
)

INTEGRATIONS = (("euler", "One Euler step per sample, equation (3)"), ("exact", "Along the arc"))

_WHEELS = ("omega_left", "omega_right")

VARIABLES = (
    Variable("time", Role.TIME, "Simulation time", "Duration"),
    Variable(
        "omega_left", Role.INPUT, "Commanded speed of the left wheel", "AngularSpeed", nominal=10.0
    ),
    Variable(
        "omega_right",
        Role.INPUT,
        "Commanded speed of the right wheel",
        "AngularSpeed",
        nominal=10.0,
    ),
    Variable("x", Role.STATE, "Position along x", "Position", nominal=1.0),
    Variable("y", Role.STATE, "Position along y", "Position", nominal=1.0),
    Variable("theta", Role.STATE, "Heading", "Heading", nominal=1.0),
    Variable("x_meas", Role.SAMPLED, "Measured x at the last sample", "Position", nominal=1.0),
    Variable("y_meas", Role.SAMPLED, "Measured y at the last sample", "Position", nominal=1.0),
    Variable(
        "theta_meas", Role.SAMPLED, "Measured heading at the last sample", "Heading", nominal=1.0
    ),
    Variable("v", Role.ALGEBRAIC, "Speed of the body", "Speed", nominal=1.0, depends_on=_WHEELS),
    Variable(
        "omega",
        Role.ALGEBRAIC,
        "Turning speed of the body",
        "AngularSpeed",
        nominal=1.0,
        depends_on=_WHEELS,
    ),
    Variable(
        "der(x)",
        Role.DERIVATIVE,
        "Speed along x",
        "Speed",
        state="x",
        depends_on=(*_WHEELS, "theta"),
    ),
    Variable(
        "der(y)",
        Role.DERIVATIVE,
        "Speed along y",
        "Speed",
        state="y",
        depends_on=(*_WHEELS, "theta"),
    ),
    Variable(
        "der(theta)",
        Role.DERIVATIVE,
        "Turning speed",
        "AngularSpeed",
        state="theta",
        depends_on=_WHEELS,
    ),
    Variable(
        "wheel_radius", Role.PARAMETER, "Nominal wheel radius", "Length", 0.05, 1e-4, 10.0, 0.1
    ),
    Variable(
        "track",
        Role.PARAMETER,
        "Nominal distance between the wheels",
        "Length",
        0.6,
        1e-3,
        100.0,
        1.0,
    ),
    Variable(
        "sample_time", Role.PARAMETER, "Time between samples", "Duration", 0.01, 1e-6, 100.0, 0.01
    ),
    Variable(
        "wheel_noise_variance",
        Role.PARAMETER,
        "Variance of each wheel's speed noise",
        "SpeedVariance",
        0.01,
        0.0,
        1e6,
        0.01,
    ),
    Variable(
        "measurement_variance_x",
        Role.PARAMETER,
        "Variance of measured x",
        "PositionVariance",
        0.01,
        0.0,
        1e6,
        0.01,
    ),
    Variable(
        "measurement_variance_y",
        Role.PARAMETER,
        "Variance of measured y",
        "PositionVariance",
        0.01,
        0.0,
        1e6,
        0.01,
    ),
    Variable(
        "measurement_variance_theta",
        Role.PARAMETER,
        "Variance of the measured heading",
        "HeadingVariance",
        0.018,
        0.0,
        1e6,
        0.01,
    ),
    Variable("x_start", Role.PARAMETER, "Position along x at the start", "Position", nominal=1.0),
    Variable("y_start", Role.PARAMETER, "Position along y at the start", "Position", nominal=1.0),
    Variable("theta_start", Role.PARAMETER, "Heading at the start", "Heading", nominal=1.0),
    Variable(
        "wheel_speed_max",
        Role.PARAMETER,
        "Limit of each wheel drive; 0 for none",
        "AngularSpeed",
        0.0,
        0.0,
        1e6,
        10.0,
    ),
    Variable(
        "motor_time_constant",
        Role.PARAMETER,
        "First-order lag of the wheel drives; 0 for none",
        "Duration",
        0.0,
        0.0,
        100.0,
        0.1,
    ),
    Variable(
        "wheel_radius_error",
        Role.PARAMETER,
        "True wheel radius over the nominal one, less 1",
        "Ratio",
        0.0,
        -0.9,
        10.0,
        0.01,
    ),
    Variable(
        "track_error",
        Role.PARAMETER,
        "True track over the nominal one, less 1",
        "Ratio",
        0.0,
        -0.9,
        10.0,
        0.01,
    ),
    Variable(
        "wheel_slip",
        Role.PARAMETER,
        "Part of the wheels' motion lost to slip",
        "Ratio",
        0.0,
        0.0,
        1.0,
        0.01,
    ),
    Variable(
        "seed",
        Role.PARAMETER,
        "Seed of all noise",
        start=1,
        minimum=0,
        maximum=2**31 - 1,
        kind=Kind.INT32,
    ),
    Variable(
        "noise", Role.PARAMETER, "false: every variance acts as zero", start=1, kind=Kind.BOOLEAN
    ),
    Variable(
        "integration",
        Role.PARAMETER,
        "How co-simulation moves the robot",
        "Integration",
        start=1,
        minimum=1,
        maximum=len(INTEGRATIONS),
        kind=Kind.ENUMERATION,
    ),
    Variable(
        "robots",
        Role.ROBOTS,
        "Number of robots in the fleet",
        start=1,
        minimum=1,
        maximum=1e6,
        kind=Kind.UINT64,
    ),
)

REFERENCE = {variable.name: reference for reference, variable in enumerate(VARIABLES)}
"""Value reference by name."""
