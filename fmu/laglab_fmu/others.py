"""The tables of the other robots that ship, which are told body speeds."""

from laglab_fmu.variables import REFERENCE, VARIABLES, Role, Variable

_COMMANDS = ("v_command", "omega_command")
_DRAWN = ("seed", "noise")


def _parameter(
    name: str,
    description: str,
    declared: str,
    start: float,
    least: float | None = None,
    most: float | None = None,
) -> Variable:
    return Variable(name, Role.PARAMETER, description, declared, start, least, most, 1.0)


def _lag(name: str, description: str) -> Variable:
    return _parameter(name, description, "Duration", 0.0, 0.0, 100.0)


def _gain(name: str, description: str) -> Variable:
    return Variable(name, Role.TUNABLE, description, "Ratio", 1.0, 0.0, 1e3, 1.0)


def _input(name: str, description: str, declared: str) -> Variable:
    return Variable(name, Role.INPUT, description, declared, nominal=1.0)


def _pose() -> tuple[Variable, ...]:
    told = {"x": ("Position along x", "Position"), "y": ("Position along y", "Position")}
    told["theta"] = ("Heading", "Heading")
    states = tuple(
        Variable(
            name,
            Role.STATE,
            *said,
            nominal=1.0,
            depends_on=(name,),
            depends_at_start_on=(f"{name}_start",),
        )
        for name, said in told.items()
    )
    measured = tuple(
        Variable(
            f"{name}_meas",
            Role.SAMPLED,
            f"{said[0]}, as measured at the last sample",
            said[1],
            nominal=1.0,
            depends_at_start_on=(
                *(f"measurement_variance_{name}", f"{name}_start", *_DRAWN),
                "measurement_noise_gain",
            ),
        )
        for name, said in told.items()
    )
    return states + measured


def _moves(v: tuple[str, ...], omega: tuple[str, ...], slides: bool) -> tuple[Variable, ...]:
    """Body speeds and derivatives; which parameters the two speeds follow from at the start."""
    at_start_v, at_start = (*_COMMANDS, *v), (*_COMMANDS, *v, *omega)
    along = at_start if slides else at_start_v
    said = (
        ("v", Role.ALGEBRAIC, "Speed of the body", "Speed", "", _COMMANDS, along),
        (
            "omega",
            Role.ALGEBRAIC,
            "Turning speed of the body",
            "AngularSpeed",
            "",
            _COMMANDS,
            at_start,
        ),
        (
            "der(x)",
            Role.DERIVATIVE,
            "Speed along x",
            "Speed",
            "x",
            (*_COMMANDS, "theta"),
            (*along, "theta_start"),
        ),
        (
            "der(y)",
            Role.DERIVATIVE,
            "Speed along y",
            "Speed",
            "y",
            (*_COMMANDS, "theta"),
            (*along, "theta_start"),
        ),
        (
            "der(theta)",
            Role.DERIVATIVE,
            "Turning speed",
            "AngularSpeed",
            "theta",
            _COMMANDS,
            at_start,
        ),
    )
    return tuple(
        Variable(
            name,
            role,
            description,
            declared,
            nominal=1.0,
            state=state,
            depends_on=depends,
            depends_at_start_on=at,
        )
        for name, role, description, declared, state, depends, at in said
    )


def _common() -> tuple[Variable, ...]:
    return (
        _parameter("sample_time", "Time between samples", "Duration", 0.01, 1e-6, 100.0),
        _parameter("measurement_variance_x", "Of measured x", "PositionVariance", 0.01, 0.0, 1e6),
        _parameter("measurement_variance_y", "Of measured y", "PositionVariance", 0.01, 0.0, 1e6),
        _parameter(
            "measurement_variance_theta",
            "Of the measured heading",
            "HeadingVariance",
            0.018,
            0.0,
            1e6,
        ),
        _parameter("x_start", "x at the start", "Position", 0.0),
        _parameter("y_start", "y at the start", "Position", 0.0),
        _parameter("theta_start", "Heading at the start", "Heading", 0.0),
    )


_WHOLE = tuple(VARIABLES[REFERENCE[name]] for name in ("seed", "noise", "integration", "robots"))
"""As every robot of ours has them."""

_TOLD = (
    Variable("time", Role.TIME, "Simulation time", "Duration"),
    _input("v_command", "Commanded speed", "Speed"),
    _input("omega_command", "Commanded turning speed", "AngularSpeed"),
)
_SHAKEN = ("sample_time", *_DRAWN)
CAR = (
    *_TOLD,
    *_pose(),
    *_moves(
        ("speed_max", "speed_time_constant", "speed_noise_variance", "drive_noise_gain", *_SHAKEN),
        ("wheelbase", "steering_max", "steering_time_constant", "steering_noise_variance"),
        slides=False,
    ),
    *_common(),
    _parameter("wheelbase", "From the rear axle to the front one", "Length", 0.5, 1e-3, 100.0),
    _parameter("speed_max", "Limit of the speed; 0 for none", "Speed", 0.0, 0.0, 1e6),
    _parameter("steering_max", "Limit of the steering angle", "Heading", 0.6, 1e-3, 1.5),
    _lag("speed_time_constant", "First-order lag of the drive; 0 for none"),
    _parameter(
        "steering_time_constant",
        "First-order lag of the steering; 0 for none",
        "Duration",
        0.1,
        0.0,
        100.0,
    ),
    _parameter("speed_noise_variance", "Of the speed", "BodySpeedVariance", 2.5e-5, 0.0, 1e6),
    _parameter(
        "steering_noise_variance", "Of the steering angle", "HeadingVariance", 1e-4, 0.0, 1e6
    ),
    *_WHOLE,
    _gain("drive_noise_gain", "Of the noise of drive and steering, from the next sample on"),
    _gain("measurement_noise_gain", "Of the measurement's noise, from the next sample on"),
)
_WHEELS = (
    *("wheel_radius", "body_radius", "wheel_speed_max", "motor_time_constant"),
    *("wheel_radius_error", "first_wheel_error", "wheel_noise_variance", "wheel_noise_gain"),
)
OMNI = (
    *_TOLD,
    *_pose(),
    *_moves((*_WHEELS, *_SHAKEN), (), slides=True),
    *_common(),
    _parameter("wheel_radius", "Nominal wheel radius", "Length", 0.05, 1e-4, 10.0),
    _parameter("body_radius", "From the middle to each wheel", "Length", 0.2, 1e-3, 100.0),
    _parameter(
        "wheel_speed_max", "Limit of each wheel drive; 0 for none", "AngularSpeed", 0.0, 0.0, 1e6
    ),
    _lag("motor_time_constant", "First-order lag of the wheel drives; 0 for none"),
    _parameter(
        "wheel_radius_error", "True wheel radius over nominal, less 1", "Ratio", 0.0, -0.9, 10.0
    ),
    _parameter("first_wheel_error", "The same of the first wheel alone", "Ratio", 0.0, -0.9, 10.0),
    _parameter("wheel_noise_variance", "Of each wheel's speed", "SpeedVariance", 0.01, 0.0, 1e6),
    *_WHOLE,
    _gain("wheel_noise_gain", "Of the wheels' noise, from the next sample on"),
    _gain("measurement_noise_gain", "Of the measurement's noise, from the next sample on"),
)
