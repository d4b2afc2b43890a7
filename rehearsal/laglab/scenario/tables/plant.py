"""`[plant]`: the simulated robot, and what the controller believes of it."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from laglab.scenario.tables.table import POSE, Pose, Table, as_in
from laglab_control import RobotModel
from laglab_gateway.values import NotNegative, Number, Positive, Seconds, described, saying

Share = Annotated[Number, Field(gt=-1, lt=1)]


class PlantEvent(Table):
    """Somebody moves the robot by hand: it is elsewhere from then on, at rest."""

    at: Annotated[Seconds, described("s", "When, at the first tick that is not earlier.")] = 0.0
    place: Annotated[Pose | None, described(POSE, "Where it is put down; either this or `by`.")] = (
        None
    )
    by: Annotated[
        Pose | None, described(POSE, "How far it is pushed from where it is, along x, y and θ.")
    ] = None

    @model_validator(mode="after")
    def _somewhere(self) -> Self:
        if (self.place is None) == (self.by is None):
            raise ValueError("give either place or by")
        return self


class PlantTable(Table):
    """The robot. Its errors, limits and lags are its own; the controller does not know of them."""

    fmi: Annotated[Literal[2, 3], described("1", "The FMI version of its FMU, 2 or 3.")] = 3
    integration: Annotated[
        Literal["euler", "exact"],
        described("-", "How it moves in a tick: `euler` as in (3), or `exact`, along the arc."),
    ] = "euler"
    wheel_radius: Annotated[
        Number, as_in(RobotModel, "wheel_radius"), described("m", "The wheels' radius r in (1).")
    ] = RobotModel.wheel_radius
    track: Annotated[
        Number, as_in(RobotModel, "track"), described("m", "The distance L between the wheels.")
    ] = RobotModel.track
    wheel_noise_variance: Annotated[
        NotNegative,
        described("(rad/s)²", "Variance of each wheel's speed, the diagonal of Q in (30)."),
    ] = 0.01
    measurement_variance: Annotated[
        tuple[Positive, Positive, Positive],
        saying("three variances above 0, of x, y and theta"),
        described(
            "m², m², rad²", "Variances of the measured x, y and θ, the diagonal of R in (30)."
        ),
    ] = (0.01, 0.01, 0.018)
    wheel_speed_max: Annotated[
        NotNegative, described("rad/s", "The fastest that a wheel turns; 0: no limit.")
    ] = 0.0
    motor_time_constant: Annotated[
        NotNegative, described("s", "First-order lag of the wheels' speeds; 0: none.")
    ] = 0.0
    wheel_radius_error: Annotated[
        Share, described("1", "The true wheel radius over `wheel_radius`, less 1.")
    ] = 0.0
    track_error: Annotated[Share, described("1", "The true track over `track`, less 1.")] = 0.0
    wheel_slip: Annotated[
        Number,
        Field(ge=0, lt=1),
        described("1", "The part of the wheels' motion that is lost to slip."),
    ] = 0.0
    event: Annotated[
        tuple[PlantEvent, ...], described("-", "Times at which somebody moves the robot by hand.")
    ] = ()
