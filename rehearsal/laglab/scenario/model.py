"""Scenarios: what is run, as TOML files, checked field by field."""

import math
import re
import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import tomlkit
from numpy.typing import NDArray
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    FiniteFloat,
    NonNegativeInt,
    ValidationError,
    field_validator,
    model_validator,
)

from laglab.errors import ScenarioError
from laglab.scenario.timeline_file import read_timeline
from laglab_control import ESTIMATORS
from laglab_gateway import IDEAL, Event, Impairments, Safety, TimelineError, read_link_log

SHIPPED = resources.files("laglab.scenario") / "shipped"


def _split_pose(value: object) -> object:
    if not isinstance(value, str) or re.fullmatch(r"\s*[a-z]+\s*", value):
        return value
    try:
        return [float(part) for part in value.split(",")]
    except ValueError:
        raise ValueError(f"{value!r} is not X,Y,THETA") from None


Pose = Annotated[
    tuple[FiniteFloat, FiniteFloat, FiniteFloat],
    BeforeValidator(_split_pose),
]
"""x [m], y [m], theta [rad]; on the command line ``X,Y,THETA``."""
Positive = Annotated[FiniteFloat, Field(gt=0)]
Share = Annotated[FiniteFloat, Field(gt=-1, lt=1)]
NotNegative = Annotated[FiniteFloat, Field(ge=0)]


class LinkScenario(BaseModel):
    """What the link does besides the two delays, each direction on its own; ideal by default."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    command: Impairments = IDEAL
    measurement: Impairments = IDEAL
    event: tuple[Event, ...] = ()
    replay: str | None = None
    """The `link.csv` of an earlier run, whose frames' fates are to come true again."""

    @field_validator("replay")
    @classmethod
    def _readable(cls, replay: str | None) -> str | None:
        if replay is not None:
            try:
                read_link_log(Path(replay), "command")
            except TimelineError as error:
                raise ValueError(str(error)) from error
        return replay


class Scenario(BaseModel):
    """One rehearsal, whole. SI units; delays in ticks; the defaults are the paper's."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = ""
    description: str = ""
    estimator: str = "popf"
    compare: tuple[str, ...] = ()
    start: Pose = (-3.0, -3.0, 0.0)
    goal: Pose = (0.0, 0.0, 0.0)
    command_delay: NonNegativeInt = 10
    measurement_delay: NonNegativeInt = 20
    duration: Positive = 10.0
    seed: Annotated[int, Field(ge=0, lt=2**31)] = 1
    noise: bool = False
    fmi: Literal[2, 3] = 3
    initial_covariance: NotNegative = 1e-4
    initial_estimate: Annotated[
        Pose | Literal["start", "drawn"], Field(union_mode="left_to_right")
    ] = "start"
    gamma: Positive = 3.0
    lambda_: Annotated[Positive, Field(alias="lambda")] = 6.0
    h: Positive = 1.0
    v_max: Positive | None = None
    omega_max: Positive | None = None
    goal_tolerance: Positive | None = None
    sample_time: Positive = 0.01
    wheel_radius: Positive = 0.05
    track: Positive = 0.6
    wheel_noise_variance: NotNegative = 0.01
    measurement_variance: tuple[Positive, Positive, Positive] = (0.01, 0.01, 0.018)
    wheel_speed_max: NotNegative = 0.0
    motor_time_constant: NotNegative = 0.0
    wheel_radius_error: Share = 0.0
    track_error: Share = 0.0
    wheel_slip: Annotated[FiniteFloat, Field(ge=0, lt=1)] = 0.0
    pace: Literal["lockstep", "realtime"] = "lockstep"
    speed: Positive = 1.0
    silence_timeout: Positive = 3.0
    """[s] of the wall clock after which a silent side counts as gone."""
    link: LinkScenario = LinkScenario()
    safety: Safety = Safety()

    @field_validator("estimator")
    @classmethod
    def _known_estimator(cls, name: str) -> str:
        if name not in ESTIMATORS:
            raise ValueError(f"{name!r} is not one of {', '.join(ESTIMATORS)}")
        return name

    @field_validator("compare")
    @classmethod
    def _comparable(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        for name in names:
            if cls._known_estimator(name) == "raw":
                raise ValueError("'raw' estimates nothing that could be compared")
        return names

    @model_validator(mode="after")
    def _whole_ticks(self) -> "Scenario":
        if self.last_tick < 1:
            raise ValueError("duration: shorter than one sample_time")
        return self

    @property
    def last_tick(self) -> int:
        """The tick at which the run ends: duration / Ts."""
        return round(self.duration / self.sample_time)

    def first_estimate(self) -> NDArray[np.float64]:
        """x̂_0, shape (3,): the true start, a pose, or drawn from N(start, P_0) by the seed."""
        if self.initial_estimate == "drawn":
            draw = np.random.default_rng(self.seed).standard_normal(3)
            return np.array(self.start) + math.sqrt(self.initial_covariance) * draw
        pose = self.start if self.initial_estimate == "start" else self.initial_estimate
        return np.array(pose)

    @classmethod
    def from_toml(cls, text: str) -> "Scenario":
        """What `to_toml` wrote."""
        return cls.model_validate(tomllib.loads(text))

    def to_toml(self) -> str:
        """The scenario as a file that ``load`` reads back to an equal one."""
        return tomlkit.dumps(_plain(self.model_dump(by_alias=True, exclude_none=True)))


def _plain(value: Any) -> Any:
    """Without tuples, which TOML does not have."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


def shipped() -> dict[str, Scenario]:
    """The scenarios that come with the package, by name."""
    return {name: load(name) for name in _shipped_names()}


def _shipped_names() -> list[str]:
    names = (Path(file.name) for file in SHIPPED.iterdir())
    return sorted(name.stem for name in names if name.suffix == ".toml")


def load(reference: str, overrides: Mapping[str, object] | None = None) -> Scenario:
    """A scenario by its shipped name or by a path to a TOML file; `overrides` beat the file.

    An override `timeline` is the path of a file that stands in for the link's events.

    Raises:
        ScenarioError: no such scenario, not TOML, or a field that cannot be.
    """
    fields, name = _read(reference)
    fields = {"name": name} | fields | dict(overrides or {})
    if timeline := fields.pop("timeline", None):
        fields["link"] = dict(fields.get("link", {})) | read_timeline(timeline)
    try:
        return Scenario.model_validate(fields)
    except ValidationError as error:
        raise ScenarioError(f"{reference}: {_first_problem(error)}") from None


def _read(reference: str) -> tuple[dict[str, Any], str]:
    path = SHIPPED / f"{reference}.toml"
    if "/" in reference or not path.is_file():
        path = Path(reference)
    try:
        return tomllib.loads(path.read_text(encoding="utf-8")), Path(path.name).stem
    except (FileNotFoundError, IsADirectoryError):
        names = ", ".join(_shipped_names())
        raise ScenarioError(
            f"{reference}: no such scenario; shipped: {names}; or give a path to a TOML file"
        ) from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ScenarioError(f"{reference}: not a readable TOML file: {error}") from None


def _without_branches(location: tuple[int | str, ...]) -> tuple[int | str, ...]:
    """The keys as they stand in the file, less what names a union's branch."""
    return location[:1] if location[:1] == ("initial_estimate",) else location


def _first_problem(error: ValidationError) -> str:
    problem = error.errors()[0]
    field = ".".join(str(part) for part in _without_branches(problem["loc"]))
    match problem["type"]:
        case "extra_forbidden" | "unexpected_keyword_argument":
            known = ", ".join(info.alias or key for key, info in Scenario.model_fields.items())
            return f"{field}: unknown key" + (f"; known: {known}" if "." not in field else "")
        case "value_error":
            text = str(problem["ctx"]["error"])
        case _:
            text = f"{problem['msg']} (got {problem['input']!r})"
    return f"{field}: {text}" if field else text
