"""`[plant]`: the simulated robot, and what the controller believes of it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from laglab.scenario.tables.table import POSE, Options, OptionsTable, Pose, Table, as_in
from laglab_control import RobotModel
from laglab_gateway.values import (
    NotNegative,
    Number,
    Positive,
    Seconds,
    Switch,
    Whole,
    described,
    saying,
)

Fraction = Annotated[Number, Field(gt=-1, lt=1)]
SHIPPED = {
    "robot": "differential drive, told its wheels' speeds: the paper's robot",
    "car": "car-like: drives with its rear wheels, steers with its front ones, which lag",
    "omni": "omnidirectional on three wheels, driven ahead and turned",
}
"""The robots that come with the package, and what each is."""
TWO_WHEELS = (
    "wheel_speed_max",
    "motor_time_constant",
    "wheel_radius_error",
    "track_error",
    "wheel_slip",
)
"""Keys that only the paper's robot reads."""
POSE_NAMES = ("x", "y", "theta")
Name = Annotated[str, Field(strict=True, min_length=1)]
"""A variable's name in the FMU; an element of an array is `NAME[0]`."""


def _flat(tables: object, above: str = "") -> Any:
    """`motor.gain = 1` is a table in TOML, and one name in an FMU."""
    if not isinstance(tables, Mapping):
        return tables
    flat: dict[str, object] = {}
    for name, value in tables.items():
        deeper = isinstance(value, Mapping)
        flat |= _flat(value, f"{above}{name}.") if deeper else {f"{above}{name}": value}
    return flat


ParameterValue = Switch | Whole | Number | str | tuple[Switch | Number, ...]
ParameterValues = Annotated[
    dict[str, ParameterValue],
    saying("a table of names and numbers, true or false, texts, or lists of the first two"),
    BeforeValidator(_flat),
    AfterValidator(OptionsTable),
]


class PlantInputs(Table):
    """The FMU's inputs: body speeds, or wheel speeds, which follow from r and L by (1)."""

    v: Annotated[Name | None, described("-", "Takes the speed [m/s].")] = None
    omega: Annotated[Name | None, described("-", "Takes the turning speed [rad/s].")] = None
    omega_left: Annotated[Name | None, described("-", "Takes the left wheel's [rad/s].")] = None
    omega_right: Annotated[Name | None, described("-", "Takes the right wheel's [rad/s].")] = None

    @model_validator(mode="after")
    def _one_pair(self) -> Self:
        if set(named(self)) not in ({"v", "omega"}, {"omega_left", "omega_right"}):
            raise ValueError("give either v and omega, or omega_left and omega_right")
        return self


class PlantOutputs(Table):
    """The FMU's outputs: where the robot is, and what a sensor of its own says of that."""

    x: Annotated[Name | None, described("-", "Gives x [m].")] = None
    y: Annotated[Name | None, described("-", "Gives y [m].")] = None
    theta: Annotated[Name | None, described("-", "Gives the heading θ [rad].")] = None
    x_meas: Annotated[Name | None, described("-", "Gives x as measured [m].")] = None
    y_meas: Annotated[Name | None, described("-", "Gives y as measured [m].")] = None
    theta_meas: Annotated[Name | None, described("-", "Gives θ as measured [rad].")] = None

    @model_validator(mode="after")
    def _whole_pose(self) -> Self:
        pose, measured = set(POSE_NAMES), {f"{name}_meas" for name in POSE_NAMES}
        if set(named(self)) not in (pose, pose | measured):
            raise ValueError(
                "give x, y and theta; where it has a sensor, x_meas, y_meas and theta_meas, too"
            )
        return self


class PlantStart(Table):
    """The FMU's variables that say where it starts; where none is, it starts where it starts."""

    x: Annotated[Name | None, described("-", "Takes x of the start [m].")] = None
    y: Annotated[Name | None, described("-", "Takes y of the start [m].")] = None
    theta: Annotated[Name | None, described("-", "Takes θ of the start [rad].")] = None

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not named(self):
            raise ValueError("give x, y and theta, or some of them")
        return self


def named(table: Table | None) -> dict[str, str]:
    """Ours → theirs, in the order of the table's keys."""
    return table.model_dump(exclude_none=True) if table else {}


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
    """The robot. Its errors, limits and lags are its own; the controller does not know of them, and
    a robot that is not of kind `robot` has none of those here."""

    kind: Annotated[
        Name,
        described(
            "-",
            f"Which robot: {', '.join(SHIPPED)}; one that is installed (`laglab plants`), or "
            "`module:Class`.",
        ),
    ] = "robot"
    fmu: Annotated[
        Annotated[Path, AfterValidator(Path.resolve)] | None,
        described("-", "Anyone's FMU in its place, FMI 2 or 3, relative to the scenario's folder."),
    ] = None
    inputs: Annotated[
        PlantInputs | None, described("-", "Which inputs of `fmu` are the command.")
    ] = None
    outputs: Annotated[
        PlantOutputs | None, described("-", "Which outputs of `fmu` are the pose.")
    ] = None
    start: Annotated[
        PlantStart | None, described("-", "Which variables of `fmu` take the start pose.")
    ] = None
    parameters: Annotated[
        ParameterValues,
        described(
            "-", "Start values of the FMU's variables, by its own names; of `car` and `omni`, too."
        ),
    ] = Field(default_factory=OptionsTable)  # type: ignore[arg-type]
    options: Annotated[
        Options,
        described("-", "What a robot that somebody brings as a class is told besides."),
    ] = Field(default_factory=OptionsTable)
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
        Fraction, described("1", "The true wheel radius over `wheel_radius`, less 1.")
    ] = 0.0
    track_error: Annotated[Fraction, described("1", "The true track over `track`, less 1.")] = 0.0
    wheel_slip: Annotated[
        Number,
        Field(ge=0, lt=1),
        described("1", "The part of the wheels' motion that is lost to slip."),
    ] = 0.0
    event: Annotated[
        tuple[PlantEvent, ...], described("-", "Times at which somebody moves the robot by hand.")
    ] = ()

    @model_validator(mode="after")
    def _of_one_kind(self) -> Self:
        ours = self.kind in SHIPPED
        if self.fmu is not None and self.kind != "robot":
            raise ValueError("give either kind or fmu")
        if self.fmu is not None and (self.inputs is None or self.outputs is None):
            raise ValueError(
                "with fmu give inputs and outputs, too: `laglab plant check FILE` proposes them"
            )
        for name in ("inputs", "outputs", "start"):
            if self.fmu is None and getattr(self, name):
                raise ValueError(f"{name}: there is no fmu that it could be of")
        if self.parameters and not self.is_mapped:
            raise ValueError(f"parameters: {self.kind} has none that are set by name")
        for name in () if self.has_two_wheels else TWO_WHEELS:
            if getattr(self, name):
                raise ValueError(f"{name}: only the robot of two wheels has it, not {self.called}")
        if ours and self.options:
            raise ValueError("options: only a robot that somebody brings as a class has some")
        return self

    @property
    def names(self) -> dict[str, dict[str, str]]:
        """Of `inputs`, `outputs` (the pose first) and `start`: ours → the FMU's."""
        tables = {"inputs": self.inputs, "outputs": self.outputs, "start": self.start}
        return {key: named(table) for key, table in tables.items()}

    @property
    def is_mapped(self) -> bool:
        """Whether it is an FMU whose variables go by a map of names: anyone's, or ours but one."""
        return self.fmu is not None or self.kind in set(SHIPPED) - {"robot"}

    @property
    def has_two_wheels(self) -> bool:
        """Whether it is the paper's."""
        return self.fmu is None and self.kind == "robot"

    @property
    def ships(self) -> bool:
        """Whether it is one of ours."""
        return self.fmu is None and self.kind in SHIPPED

    @property
    def model(self) -> str:
        """Of one of ours: the name of its FMUs, without the version of FMI."""
        return self.kind.capitalize()

    @property
    def called(self) -> str:
        """Its name, for messages."""
        return self.fmu.name if self.fmu is not None else self.kind
