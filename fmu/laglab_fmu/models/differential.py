"""The differential-drive robot, which is told its wheels' speeds."""

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

DIFFERENTIAL = (
    TIME,
    told("omega_left", "Commanded speed of the left wheel", "AngularSpeed", nominal=10.0),
    told("omega_right", "Commanded speed of the right wheel", "AngularSpeed", nominal=10.0),
    *POSE,
    *moves(
        ("omega_left", "omega_right"),
        (
            *("wheel_radius", "sample_time", "wheel_noise_variance", "wheel_speed_max"),
            *("motor_time_constant", "wheel_radius_error", "wheel_slip", *DRAWN),
            "wheel_noise_gain",
        ),
        ("track", "track_error"),
    ),
    parameter("wheel_radius", "Nominal wheel radius", "Length", (1e-4, 10.0), 0.1),
    parameter("track", "Nominal wheel distance", "Length", (1e-3, 100.0)),
    SAMPLE_TIME,
    parameter("wheel_noise_variance", "Of each wheel's speed", "SpeedVariance", VARIANCE, 0.01),
    *SENSOR_AND_START,
    parameter(
        "wheel_speed_max",
        "Limit of each wheel drive; 0 for none",
        "AngularSpeed",
        (0.0, 1e6),
        10.0,
    ),
    parameter(
        "motor_time_constant",
        "First-order lag of the wheel drives; 0 for none",
        "Duration",
        (0.0, 100.0),
        0.1,
    ),
    parameter(
        "wheel_radius_error", "True wheel radius over nominal, less 1", "Ratio", _ERROR, 0.01
    ),
    parameter("track_error", "True track over nominal, less 1", "Ratio", _ERROR, 0.01),
    parameter("wheel_slip", "Part of wheel motion lost to slip", "Ratio", (0.0, 1.0), 0.01),
    *WHOLE,
    gain("wheel_noise_gain", "Of the wheels' noise, from the next sample on"),
    MEASUREMENT_GAIN,
)
