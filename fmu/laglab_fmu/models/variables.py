"""A robot's table of variables: what a line says, and the lines that every robot has.

Both model descriptions and the C header of value references are made from it. A variable's value
reference is its place in the table, and its name, with `der(x)` read as `der_x`, is the name of its
field in the C struct `Robot`.
"""

from dataclasses import dataclass
from enum import Enum

from laglab_fmu.parameters import INTEGRATIONS, LARGEST_SEED, RobotParameters

START = RobotParameters().by_name()
"""The default values of the parameters."""


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
    TUNABLE = "tunable parameter"
    INPUT = "input"
    STATE = "state"
    SAMPLED = "sampled"
    ALGEBRAIC = "algebraic"
    DERIVATIVE = "derivative"


Names = tuple[str, ...]


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
    depends_on: Names = ()
    """of an unknown: the inputs and states it depends on"""
    depends_at_start_on: Names = ()
    """of an unknown: the inputs and parameters it depends on during initialization"""

    @property
    def field(self) -> str:
        return self.name.replace("(", "_").replace(")", "")


def told(name: str, description: str, declared: str, nominal: float = 1.0) -> Variable:
    """An input."""
    return Variable(name, Role.INPUT, description, declared, nominal=nominal)


def parameter(
    name: str,
    description: str,
    declared: str,
    bounds: tuple[float | None, float | None],
    nominal: float = 1.0,
    start: float | None = None,
) -> Variable:
    """A parameter; without a `start` it has that of RobotParameters."""
    start = START[name] if start is None else start
    return Variable(name, Role.PARAMETER, description, declared, start, *bounds, nominal)


def gain(name: str, description: str) -> Variable:
    """The gain of some noise, which may change while the robot moves."""
    return Variable(name, Role.TUNABLE, description, "Ratio", 1.0, 0.0, 1e3, 1.0)


def _unknown(
    name: str,
    role: Role,
    description: str,
    declared: str,
    depends_on: Names,
    depends_at_start_on: Names,
    state: str = "",
) -> Variable:
    return Variable(
        name,
        role,
        description,
        declared,
        nominal=1.0,
        state=state,
        depends_on=depends_on,
        depends_at_start_on=depends_at_start_on,
    )


def moves(inputs: Names, v: Names, omega: Names = ()) -> tuple[Variable, ...]:
    """Speeds of the body, and derivatives of its pose.

    Args:
        v: the parameters that the speed follows from at the start.
        omega: those that the turning speed follows from besides.
    """
    moving, turning = (*inputs, *v), (*inputs, *v, *omega)
    along = (*inputs, "theta"), (*moving, "theta_start")
    algebraic, derivative = Role.ALGEBRAIC, Role.DERIVATIVE
    turn = "AngularSpeed", inputs, turning
    return (
        _unknown("v", algebraic, "Speed of the body", "Speed", inputs, moving),
        _unknown("omega", algebraic, "Turning speed of the body", *turn),
        _unknown("der(x)", derivative, "Speed along x", "Speed", *along, "x"),
        _unknown("der(y)", derivative, "Speed along y", "Speed", *along, "y"),
        _unknown("der(theta)", derivative, "Turning speed", *turn, "theta"),
    )


FREE = (None, None)
VARIANCE = (0.0, 1e6)
DRAWN = ("seed", "noise")
"""The parameters that every noise follows from."""
_AXES = (
    ("x", "Position along x", "Position"),
    ("y", "Position along y", "Position"),
    ("theta", "Heading", "Heading"),
)

TIME = Variable("time", Role.TIME, "Simulation time", "Duration")
POSE = (
    *(
        _unknown(axis, Role.STATE, said, declared, (axis,), (f"{axis}_start",))
        for axis, said, declared in _AXES
    ),
    *(
        _unknown(
            f"{axis}_meas",
            Role.SAMPLED,
            f"{said}, as measured at the last sample",
            declared,
            (),
            (
                *(f"measurement_variance_{axis}", f"{axis}_start", *DRAWN),
                "measurement_noise_gain",
            ),
        )
        for axis, said, declared in _AXES
    ),
)
SAMPLE_TIME = parameter("sample_time", "Time between samples", "Duration", (1e-6, 100.0), 0.01)
SENSOR_AND_START = (
    parameter("measurement_variance_x", "Of measured x", "PositionVariance", VARIANCE, 0.01),
    parameter("measurement_variance_y", "Of measured y", "PositionVariance", VARIANCE, 0.01),
    parameter(
        "measurement_variance_theta", "Of the measured heading", "HeadingVariance", VARIANCE, 0.01
    ),
    parameter("x_start", "x at the start", "Position", FREE),
    parameter("y_start", "y at the start", "Position", FREE),
    parameter("theta_start", "Heading at the start", "Heading", FREE),
)
WHOLE = (
    Variable(
        "seed",
        Role.PARAMETER,
        "Seed of all noise",
        start=START["seed"],
        minimum=0,
        maximum=LARGEST_SEED,
        kind=Kind.INT32,
    ),
    Variable(
        "noise",
        Role.PARAMETER,
        "false: every variance acts as zero",
        start=START["noise"],
        minimum=0,
        maximum=1,
        kind=Kind.BOOLEAN,
    ),
    Variable(
        "integration",
        Role.PARAMETER,
        "How co-simulation moves the robot",
        "Integration",
        start=START["integration"],
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
"""Those that are no real numbers."""
MEASUREMENT_GAIN = gain(
    "measurement_noise_gain", "Of the measurement's noise, from the next sample on"
)
