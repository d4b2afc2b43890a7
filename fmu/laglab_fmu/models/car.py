"""The car-like robot, which is told the speeds of its body."""

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

_LAG = (0.0, 100.0)

CAR = (
    TIME,
    told("v_command", "Commanded speed", "Speed"),
    told("omega_command", "Commanded turning speed", "AngularSpeed"),
    *POSE,
    *moves(
        ("v_command", "omega_command"),
        (
            *("speed_max", "speed_time_constant", "speed_noise_variance", "drive_noise_gain"),
            *("sample_time", *DRAWN),
        ),
        ("wheelbase", "steering_max", "steering_time_constant", "steering_noise_variance"),
    ),
    SAMPLE_TIME,
    *SENSOR_AND_START,
    parameter(
        "wheelbase", "From the rear axle to the front one", "Length", (1e-3, 100.0), start=0.5
    ),
    parameter("speed_max", "Limit of the speed; 0 for none", "Speed", (0.0, 1e6), start=0.0),
    parameter("steering_max", "Limit of the steering angle", "Heading", (1e-3, 1.5), start=0.6),
    parameter(
        "speed_time_constant",
        "First-order lag of the drive; 0 for none",
        "Duration",
        _LAG,
        start=0.0,
    ),
    parameter(
        "steering_time_constant",
        "First-order lag of the steering; 0 for none",
        "Duration",
        _LAG,
        start=0.1,
    ),
    parameter("speed_noise_variance", "Of the speed", "BodySpeedVariance", VARIANCE, start=2.5e-5),
    parameter(
        "steering_noise_variance",
        "Of the steering angle",
        "HeadingVariance",
        VARIANCE,
        start=1e-4,
    ),
    *WHOLE,
    gain("drive_noise_gain", "Of the noise of drive and steering, from the next sample on"),
    MEASUREMENT_GAIN,
)
