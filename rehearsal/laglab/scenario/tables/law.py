"""`[law]`: the control law's gains and limits."""

from typing import Annotated

from pydantic import Field

from laglab.scenario.tables.table import Table, as_in
from laglab_control import Law
from laglab_gateway.values import Number, described


class LawTable(Table):
    """The polar law (2), (4); without its limits and its tolerance it is the paper's."""

    gamma: Annotated[
        Number, as_in(Law, "gamma"), described("1/s", "Gain γ of the distance to the goal.")
    ] = Law.gamma
    lambda_: Annotated[
        Number,
        as_in(Law, "lambda_"),
        Field(alias="lambda"),
        described("1/s", "Gain λ of the bearing of the goal."),
    ] = Law.lambda_
    h: Annotated[
        Number, as_in(Law, "h"), described("1", "Weight h of the heading that the goal wants.")
    ] = Law.h
    v_max: Annotated[
        Number | None,
        as_in(Law, "v_max"),
        described("m/s", "The fastest command; faster ones are clamped."),
    ] = Law.v_max
    omega_max: Annotated[
        Number | None,
        as_in(Law, "omega_max"),
        described("rad/s", "The fastest turn commanded; faster ones are clamped."),
    ] = Law.omega_max
    goal_tolerance: Annotated[
        Number | None,
        as_in(Law, "goal_tolerance"),
        described("m", "Nearer to the goal the robot only turns, until it is twice as far again."),
    ] = Law.goal_tolerance
    caution: Annotated[
        Number | None,
        as_in(Law, "caution"),
        described(
            "m",
            "Where the claimed standard deviation of the position is larger, the robot drives the "
            "more slowly, in proportion.",
        ),
    ] = Law.caution
