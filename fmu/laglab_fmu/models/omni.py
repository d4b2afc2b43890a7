"""The omnidirectional robot, which is told the speeds of its body."""

from laglab_fmu.models.variables import (
    DRAWN,
    MEASUREMENT_GAIN,
    POSE,
    SAMPLE_TIME,
    SENSOR_AND_START,
    TIME,
    VARIANCE,
    WHOLE,
    gain,
    moves,
    parameter,
    told,
)

_ERROR = (-0.9, 10.0)

OMNI = (
    TIME,
    told("v_command", "Commanded speed", "Speed"),
    told("omega_command", "Commanded turning speed", "AngularSpeed"),
    *POSE,
    *moves(
        ("v_command", "omega_command"),
        (
            *("wheel_radius", "body_radius", "wheel_speed_max", "motor_time_constant"),
            *("wheel_radius_error", "first_wheel_error", "wheel_noise_variance"),
            *("wheel_noise_gain", "sample_time", *DRAWN),
        ),
    ),
    SAMPLE_TIME,
    *SENSOR_AND_START,
    parameter("wheel_radius", "Nominal wheel radius", "Length", (1e-4, 10.0)),
    parameter("body_radius", "From the middle to each wheel", "Length", (1e-3, 100.0), start=0.2),
    parameter(
        "wheel_speed_max", "Limit of each wheel drive; 0 for none", "AngularSpeed", (0.0, 1e6)
    ),
    parameter(
        "motor_time_constant",
        "First-order lag of the wheel drives; 0 for none",
        "Duration",
        (0.0, 100.0),
    ),
    parameter("wheel_radius_error", "True wheel radius over nominal, less 1", "Ratio", _ERROR),
    parameter("first_wheel_error", "The same of the first wheel alone", "Ratio", _ERROR, start=0.0),
    parameter("wheel_noise_variance", "Of each wheel's speed", "SpeedVariance", VARIANCE),
    *WHOLE,
    gain("wheel_noise_gain", "Of the wheels' noise, from the next sample on"),
    MEASUREMENT_GAIN,
)
