"""`[law]`: the control law's gains and limits."""

from typing import Annotated, Any

from pydantic import Field

from laglab.scenario.tables.table import Table, as_in
from laglab_control import PolarLaw, SpeedLimits
from laglab_control.limits import limits
from laglab_gateway.values import Number, described


class LawTable(Table):
    """The polar law (2), (4); without its limits and its tolerance it is the paper's."""

    gamma: Annotated[
        Number, as_in(PolarLaw, "gamma"), described("1/s", "Gain γ of the distance to the goal.")
    ] = PolarLaw.gamma
    lambda_: Annotated[
        Number,
        as_in(PolarLaw, "lambda_"),
        Field(alias="lambda"),
        described("1/s", "Gain λ of the bearing of the goal."),
    ] = PolarLaw.lambda_
    h: Annotated[
        Number, as_in(PolarLaw, "h"), described("1", "Weight h of the heading that the goal wants.")
    ] = PolarLaw.h
    v_max: Annotated[
        Number | None,
        as_in(SpeedLimits, "v_max"),
        described("m/s", "The fastest command; faster ones are clamped."),
    ] = SpeedLimits.v_max
    omega_max: Annotated[
        Number | None,
        as_in(SpeedLimits, "omega_max"),
        described("rad/s", "The fastest turn commanded; faster ones are clamped."),
    ] = SpeedLimits.omega_max
    accel_max: Annotated[
        Number | None,
        as_in(SpeedLimits, "accel_max"),
        described("m/s²", "The most that the commanded v changes in a second."),
    ] = SpeedLimits.accel_max
    alpha_max: Annotated[
        Number | None,
        as_in(SpeedLimits, "alpha_max"),
        described("rad/s²", "The most that the commanded ω changes in a second."),
    ] = SpeedLimits.alpha_max
    goal_tolerance: Annotated[
        Number | None,
        as_in(PolarLaw, "goal_tolerance"),
        described("m", "Nearer to the goal the robot only turns, until it is twice as far again."),
    ] = PolarLaw.goal_tolerance
    caution: Annotated[
        Number | None,
        as_in(SpeedLimits, "caution"),
        described(
            "m",
            "Where the claimed standard deviation of the position is larger, the robot drives the "
            "more slowly, in proportion.",
        ),
    ] = SpeedLimits.caution

    def of(self, made: type) -> dict[str, Any]:
        """Its own keys, for the fields of one of the controller's classes."""
        return {name: getattr(self, name) for name in limits(made)}
