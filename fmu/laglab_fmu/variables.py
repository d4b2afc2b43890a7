"""The one table of the robot's variables.

Both model descriptions and the C header of value references are made from it. A variable's value
reference is its place in the table, and its name, with `der(x)` read as `der_x`, is the name of its
field in the C struct `Robot`.
"""

from dataclasses import dataclass, replace
from enum import Enum

from laglab_fmu.parameters import INTEGRATIONS, LARGEST_SEED, RobotParameters

MODEL_NAME = "Robot"
START = RobotParameters().by_name()
"""Of the parameters."""


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
    depends_at_start_on: tuple[str, ...] = ()
    """of an unknown: the inputs and parameters it depends on during initialization"""

    @property
    def field(self) -> str:
        return self.name.replace("(", "_").replace(")", "")


_WHEELS = ("omega_left", "omega_right")
_DRAWN = ("seed", "noise")
_V_AT_START = (
    *_WHEELS,
    *("wheel_radius", "sample_time", "wheel_noise_variance", "wheel_speed_max"),
    *("motor_time_constant", "wheel_radius_error", "wheel_slip", *_DRAWN, "wheel_noise_gain"),
)
_OMEGA_AT_START = (*_V_AT_START, "track", "track_error")


def _input(name: str, description: str) -> Variable:
    return Variable(name, Role.INPUT, description, "AngularSpeed", nominal=10.0)


def _output(
    name: str, role: Role, description: str, declared: str, depends_on: tuple[str, ...] = ()
) -> Variable:
    return Variable(name, role, description, declared, nominal=1.0, depends_on=depends_on)


def _state(name: str, description: str, declared: str) -> Variable:
    return replace(
        _output(name, Role.STATE, description, declared, (name,)),
        depends_at_start_on=(f"{name}_start",),
    )


def _measured(state: str, description: str, declared: str) -> Variable:
    return replace(
        _output(f"{state}_meas", Role.SAMPLED, description, declared),
        depends_at_start_on=(
            *(f"measurement_variance_{state}", f"{state}_start", *_DRAWN),
            "measurement_noise_gain",
        ),
    )


def _speed(name: str, description: str, declared: str, at_start: tuple[str, ...]) -> Variable:
    return replace(
        _output(name, Role.ALGEBRAIC, description, declared, _WHEELS), depends_at_start_on=at_start
    )


def _derivative(state: str, description: str, declared: str, *depends_on: str) -> Variable:
    at_start = (*_V_AT_START, "theta_start") if depends_on else _OMEGA_AT_START
    return Variable(
        f"der({state})",
        Role.DERIVATIVE,
        description,
        declared,
        state=state,
        depends_on=(*_WHEELS, *depends_on),
        depends_at_start_on=at_start,
    )


def _parameter(
    name: str,
    description: str,
    declared: str,
    bounds: tuple[float | None, float | None],
    nominal: float,
) -> Variable:
    return Variable(name, Role.PARAMETER, description, declared, START[name], *bounds, nominal)


def _gain(name: str, description: str) -> Variable:
    return Variable(name, Role.TUNABLE, description, "Ratio", 1.0, 0.0, 1e3, 1.0)


_FREE = (None, None)
_VARIANCE = (0.0, 1e6)
_ERROR = (-0.9, 10.0)

VARIABLES = (
    Variable("time", Role.TIME, "Simulation time", "Duration"),
    _input("omega_left", "Commanded speed of the left wheel"),
    _input("omega_right", "Commanded speed of the right wheel"),
    _state("x", "Position along x", "Position"),
    _state("y", "Position along y", "Position"),
    _state("theta", "Heading", "Heading"),
    _measured("x", "x as measured at the last sample", "Position"),
    _measured("y", "y as measured at the last sample", "Position"),
    _measured("theta", "Heading as measured at the last sample", "Heading"),
    _speed("v", "Speed of the body", "Speed", _V_AT_START),
    _speed("omega", "Turning speed of the body", "AngularSpeed", _OMEGA_AT_START),
    _derivative("x", "Speed along x", "Speed", "theta"),
    _derivative("y", "Speed along y", "Speed", "theta"),
    _derivative("theta", "Turning speed", "AngularSpeed"),
    _parameter("wheel_radius", "Nominal wheel radius", "Length", (1e-4, 10.0), 0.1),
    _parameter("track", "Nominal wheel distance", "Length", (1e-3, 100.0), 1.0),
    _parameter("sample_time", "Time between samples", "Duration", (1e-6, 100.0), 0.01),
    _parameter("wheel_noise_variance", "Of each wheel's speed", "SpeedVariance", _VARIANCE, 0.01),
    _parameter("measurement_variance_x", "Of measured x", "PositionVariance", _VARIANCE, 0.01),
    _parameter("measurement_variance_y", "Of measured y", "PositionVariance", _VARIANCE, 0.01),
    _parameter(
        "measurement_variance_theta", "Of the measured heading", "HeadingVariance", _VARIANCE, 0.01
    ),
    _parameter("x_start", "x at the start", "Position", _FREE, 1.0),
    _parameter("y_start", "y at the start", "Position", _FREE, 1.0),
    _parameter("theta_start", "Heading at the start", "Heading", _FREE, 1.0),
    _parameter(
        "wheel_speed_max",
        "Limit of each wheel drive; 0 for none",
        "AngularSpeed",
        (0.0, 1e6),
        10.0,
    ),
    _parameter(
        "motor_time_constant",
        "First-order lag of the wheel drives; 0 for none",
        "Duration",
        (0.0, 100.0),
        0.1,
    ),
    _parameter(
        "wheel_radius_error", "True wheel radius over nominal, less 1", "Ratio", _ERROR, 0.01
    ),
    _parameter("track_error", "True track over nominal, less 1", "Ratio", _ERROR, 0.01),
    _parameter("wheel_slip", "Part of wheel motion lost to slip", "Ratio", (0.0, 1.0), 0.01),
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
    _gain("wheel_noise_gain", "Of the wheels' noise, from the next sample on"),
    _gain("measurement_noise_gain", "Of the measurement's noise, from the next sample on"),
)

REFERENCE = {variable.name: reference for reference, variable in enumerate(VARIABLES)}
"""Value reference by name."""


def parameter_names(kind: Kind) -> list[str]:
    """Names of the parameters of one type."""
    return [v.name for v in VARIABLES if v.role is Role.PARAMETER and v.kind is kind]
