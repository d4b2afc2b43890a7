"""A scenario: one rehearsal, whole."""

import math
import os
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

import laglab_control as control
from laglab.errors import ScenarioError
from laglab.scenario import paths
from laglab.scenario.overrides import Overrides
from laglab.scenario.tables.estimator import EstimatorTable
from laglab.scenario.tables.law import LawTable
from laglab.scenario.tables.link import LinkTable
from laglab.scenario.tables.plant import PlantTable
from laglab.scenario.tables.table import POSE, Pose, Table, as_in
from laglab.scenario.target import Target
from laglab.scenario.toml import parsed
from laglab_control import FAR, RobotModel, is_far
from laglab_gateway import Origin, Safety
from laglab_gateway.values import Duration, Number, Positive, Switch, Whole, described

FILES = (("link", "replay"), ("plant", "fmu"))
"""Keys that name files, relative to the scenario's folder."""
LAST = 2**32 - 1
"""The last tick that the dialect can tell."""


class Scenario(Table):
    """What is run, for how long and at which pace; the tables say the rest."""

    name: Annotated[str, described("-", "What the run is called; by default as its file is.")] = ""
    description: Annotated[str, described("-", "What it shows, in a line.")] = ""
    start: Annotated[Pose, described(POSE, "The pose x, y, θ at which the robot starts.")] = (
        -3.0,
        -3.0,
        0.0,
    )
    goal: Annotated[Pose, described(POSE, "The pose x, y, θ to which it is to come.")] = (
        0.0,
        0.0,
        0.0,
    )
    duration: Annotated[
        Duration, described("s", "How long the run lasts; `inf`: until somebody ends it.")
    ] = 10.0
    sample_time: Annotated[
        Number, as_in(RobotModel, "sample_time"), described("s", "The length Ts of a tick.")
    ] = RobotModel.sample_time
    seed: Annotated[
        Whole, Field(ge=0, lt=2**31), described("1", "The seed of every random draw.")
    ] = 1
    noise: Annotated[
        Switch, described("-", "Whether wheels and sensor are noisy; the filter always expects it.")
    ] = False
    pace: Annotated[
        Literal["lockstep", "realtime"],
        described("-", "`lockstep`: each tick waits for its answer; `realtime`: none does."),
    ] = "lockstep"
    speed: Annotated[
        Positive, described("1", "In real time, how many times as fast as the clock.")
    ] = 1.0
    silence_timeout: Annotated[
        Positive, described("s", "A side that is silent for so long, by the clock, counts as gone.")
    ] = 3.0
    plant: Annotated[
        PlantTable, described("-", "The robot, and what the controller believes of it.")
    ] = PlantTable()
    estimator: Annotated[
        EstimatorTable, described("-", "The filter in the loop, and its prior.")
    ] = EstimatorTable()
    law: Annotated[LawTable, described("-", "The control law, and its limits.")] = LawTable()
    link: Annotated[
        LinkTable, described("-", "The way between the two sides: its delays, and more.")
    ] = LinkTable()
    safety: Annotated[Safety, described("-", "The robot's own limits and failsafe.")] = Safety()
    origin: Annotated[
        Origin, described("-", "Where on Earth the run takes place, for ground stations' maps.")
    ] = Origin()

    @model_validator(mode="after")
    def _whole_ticks(self) -> Self:
        ticks = self.duration / self.sample_time
        if round(min(ticks, LAST)) < 1:
            raise ValueError(f"duration: must be a sample_time or longer, not {self.duration:g}")
        if ticks > LAST and math.isfinite(self.duration):
            raise ValueError(f"duration: must be {LAST} ticks or less, not {ticks:g}")
        return self

    @model_validator(mode="after")
    def _within_reach(self) -> Self:
        poses = {"start": self.start, "estimator.initial_estimate": self.first_estimate().tolist()}
        for key, pose in poses.items():
            if is_far(pose, self.goal):
                raise ValueError(f"{key}: must be within {FAR:g} m of the goal, not {list(pose)}")
        if self.path is not None:
            for x, y in self.path.outline().tolist():
                if is_far((x, y, 0.0), self.goal):
                    raise ValueError(f"law.path: must be within {FAR:g} m of the goal")
        return self

    @property
    def path(self) -> control.Path | None:
        """What the robot is to follow; None: it is to come to the goal."""
        told = self.law.path
        return None if told is None else paths.reference_path(told, self.goal[:2])

    @property
    def target(self) -> Target:
        """Where the robot is to be at each tick."""
        return Target(self.goal, self.path, self.sample_time)

    @property
    def last_tick(self) -> int | None:
        """The tick at which the run ends, duration / Ts; None when it does not end by itself."""
        return round(self.duration / self.sample_time) if math.isfinite(self.duration) else None

    def must_end(self) -> int:
        """The last tick, for what needs whole runs. Raises: ScenarioError, when there is none."""
        if self.last_tick is None:
            raise ScenarioError(f"{self.name}: duration: must be finite here, not {self.duration}")
        return self.last_tick

    @property
    def gist(self) -> str:
        """Law, unless it is the polar one, filter, delays and noise, in a few words."""
        law = "" if self.law.kind == "polar" else f"{self.law.kind}, "
        return f"{law}{self.gist_with(self.estimator.kind)}"

    def gist_with(self, estimator: str) -> str:
        """The same, whatever the law, of whoever estimates."""
        noise = "on" if self.noise else "off"
        return f"{estimator}, n = {self.link.n}, m = {self.link.m}, noise {noise}"

    def first_estimate(self) -> NDArray[np.float64]:
        """x̂_0, shape (3,): the true start, a pose, or drawn from N(start, P_0) by the seed."""
        told = self.estimator.initial_estimate
        if told == "drawn":
            draw = np.random.default_rng(self.seed).standard_normal(3)
            return np.array(self.start) + math.sqrt(self.estimator.initial_covariance) * draw
        return np.array(self.start if told == "start" else told)

    def overridden(self, overrides: Overrides) -> "Scenario":
        """The same with other values, by dotted keys. Raises: ScenarioError, when one cannot be."""
        from laglab.scenario.loading import changed

        return changed(self, overrides)

    def fields(self, folder: Path | None = None) -> dict[str, Any]:
        """As in a file, without what is not set. Paths are relative to `folder`, or absolute."""
        fields: dict[str, Any] = plain(self.model_dump(by_alias=True, exclude_none=True))
        for table, key in FILES:
            if folder is not None and (path := fields[table].get(key)):
                fields[table][key] = os.path.relpath(path, folder.resolve())
        if folder is not None and self.law.path is not None:
            fields["law"]["path"] = paths.relative(self.law.path, folder)
        return fields

    @classmethod
    def from_toml(cls, text: str) -> "Scenario":
        """What `to_toml` wrote, with absolute paths."""
        return cls.model_validate(parsed(text))

    def to_toml(self, folder: Path | None = None) -> str:
        """The scenario as a file, in `folder`, that `load` reads back to an equal one."""
        import tomlkit  # whoever only reads does without

        return tomlkit.dumps(self.fields(folder))


def plain(value: Any) -> Any:
    """Without tuples and paths, which TOML does not have, and without tables of nothing."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items() if item != {}}
    if isinstance(value, Path):
        return str(value)
    return [plain(item) for item in value] if isinstance(value, list | tuple) else value
