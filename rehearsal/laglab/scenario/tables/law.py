"""`[law]`: which control law, its gains, and what limits its commands."""

from typing import Annotated, Any, Self

from pydantic import AfterValidator, Field, model_validator

from laglab.scenario.paths import KINDS, resolved
from laglab.scenario.tables.names import known_law, offered
from laglab.scenario.tables.table import Options, OptionsTable, Table, as_in
from laglab_control import LAWS, PolarLaw, SpeedLimits, limits
from laglab_gateway.values import Number, described

LawName = Annotated[str, AfterValidator(known_law), offered(LAWS)]


class LawTable(Table):
    """The law by which the robot is driven: the polar law (2), (4), without its limits and its
    tolerance the paper's; one that follows a path; or one's own."""

    kind: Annotated[
        LawName,
        described(
            "-",
            f"The law: {', '.join(LAWS)}, an installed plug-in's name, or `module:Class`.",
        ),
    ] = "polar"
    path: Annotated[
        Annotated[str, AfterValidator(resolved)] | None,
        described(
            "-",
            f"What the robot is to follow: {KINDS} about the goal's x and y [m, m/s], or a CSV "
            "file, relative to the scenario's folder, of the columns time, x, y, theta, v, omega.",
        ),
    ] = None
    options: Annotated[
        Options,
        described("-", "What the law is told besides; `tracking` k_x, k_y and k_theta."),
    ] = Field(default_factory=OptionsTable)
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

    @model_validator(mode="after")
    def _fitting(self) -> Self:
        if self.kind == "tracking" and self.path is None:
            raise ValueError(f"path: tracking follows one: give {KINDS} or a CSV file")
        if self.kind == "polar" and self.path is not None:
            raise ValueError('path: the polar law follows none: take kind = "tracking"')
        if self.kind == "polar" and self.options:
            raise ValueError("options: the polar law has none: its gains are keys of their own")
        return self

    def of(self, made: type) -> dict[str, Any]:
        """Its own keys, for the fields of one of the controller's classes."""
        return {name: getattr(self, name) for name in limits(made)}
