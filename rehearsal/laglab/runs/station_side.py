"""The remote station's side of a rehearsal, made from the scenario alone."""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np

from laglab.runs.staying import staying
from laglab.scenario import Scenario, changed
from laglab_control import (
    Controller,
    Law,
    PolarLaw,
    RobotModel,
    SpeedLimits,
    StationConfig,
    without_blind_guard,
)
from laglab_control.laws import brought_law, tracking_law
from laglab_protocol import STATION_COMPONENT, STATION_SYSTEM, Codec, Receiver, Sender, Settings
from laglab_station import Station


def robot_model(scenario: Scenario) -> RobotModel:
    """What the controller believes of the robot."""
    plant = scenario.plant
    return RobotModel(
        sample_time=scenario.sample_time,
        wheel_radius=plant.wheel_radius,
        track=plant.track,
        Q=plant.wheel_noise_variance * np.eye(2),
        R=np.diag(plant.measurement_variance),
    )


def control_law(scenario: Scenario) -> Law:
    """Raises PluginError or ConfigError when it cannot be made."""
    told, path = scenario.law, scenario.path
    if told.kind == "polar":
        return PolarLaw(goal=scenario.goal, **told.of(PolarLaw))
    if told.kind == "tracking":
        assert path is not None, "the table has seen to it"
        return tracking_law(path, told.options)
    return brought_law(told.kind, scenario.goal, told.options | ({"path": path} if path else {}))


def check_parts(scenario: Scenario) -> None:
    """Whatever somebody brought can be made here, the filters beside the loop too.

    Raises PluginError or ConfigError.
    """
    with staying():
        Controller(station_config(scenario)).start()
        for name in scenario.estimator.compare:
            Controller(shadow_config(scenario, name)).start()


def shadow_config(scenario: Scenario, name: str) -> StationConfig:
    """The station's side with another estimator, which looks on: with no options of its own,
    unless it is the one in the loop; unguarded where a guard would see nothing.

    Raises ScenarioError, PluginError or ConfigError when there is none, or it cannot be made.
    """
    own = scenario.estimator.kind == name
    told: dict[str, object] = {"estimator.kind": name, "estimator.options": {}}
    return without_blind_guard(station_config(scenario if own else changed(scenario, told)))


def station_config(scenario: Scenario) -> StationConfig:
    """The remote station's side."""
    return StationConfig(
        estimator=scenario.estimator.kind,
        estimator_options=scenario.estimator.options,
        model=robot_model(scenario),
        law=control_law(scenario),
        limits=SpeedLimits(**scenario.law.of(SpeedLimits)),
        goal=scenario.goal,
        initial_estimate=scenario.first_estimate(),
        initial_covariance=scenario.estimator.initial_covariance * np.eye(3),
        command_delay=scenario.link.n,
        plan=scenario.link.plan,
        guard=scenario.estimator.guard,
    )


def station_settings(scenario: Scenario) -> Settings:
    """What the robot is told to compare with."""
    v_max, omega_max = scenario.law.v_max, scenario.law.omega_max
    return Settings(
        sample_time=scenario.sample_time,
        wheel_radius=scenario.plant.wheel_radius,
        track=scenario.plant.track,
        v_max=math.inf if v_max is None else v_max,
        omega_max=math.inf if omega_max is None else omega_max,
        command_delay=scenario.link.command_delay,
        measurement_delay=scenario.link.measurement_delay,
        command_playout=scenario.link.playout.command,
        measurement_playout=scenario.link.playout.measurement,
        plan=scenario.link.plan,
    )


def make_station(
    scenario: Scenario,
    sender: Sender,
    controller: Callable[[StationConfig], Controller] = Controller,
) -> Station:
    """The station's core, whose frames `sender` makes."""
    with staying():
        return Station(
            station_config(scenario),
            controller,
            clock=time.monotonic_ns,
            sender=sender,
            settings=station_settings(scenario),
            playout=scenario.link.playout.measurement,
        )


class OpenStation(NamedTuple):
    """The remote station's side, and what it listens with."""

    station: Station
    receiver: Receiver


@contextmanager
def open_station(scenario: Scenario, key: Path | None = None) -> Iterator[OpenStation]:
    """The remote station's side, its frames signed with a key."""
    with Codec(STATION_SYSTEM, STATION_COMPONENT, key) as codec:
        yield OpenStation(make_station(scenario, codec.sender), codec.receiver)
