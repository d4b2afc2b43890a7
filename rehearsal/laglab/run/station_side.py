"""The remote station's side of a rehearsal, made from the scenario alone."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from laglab.scenario import Scenario
from laglab_control import Law, RobotModel, StationConfig
from laglab_protocol import STATION_COMPONENT, STATION_SYSTEM, Codec
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


def station_config(scenario: Scenario) -> StationConfig:
    """The remote station's side."""
    return StationConfig(
        estimator=scenario.estimator.kind,
        model=robot_model(scenario),
        law=Law(goal=scenario.goal, **dict(scenario.law)),
        initial_estimate=scenario.first_estimate(),
        initial_covariance=scenario.estimator.initial_covariance * np.eye(3),
        command_delay=scenario.link.command_delay,
    )


def station_statistics(station: Station) -> dict[str, Any]:
    """The station's own report, for the summary."""
    n, m, times, warnings = station.report()
    timed = {f"tick_{name}_s": value for name, value in times._asdict().items()} if times else {}
    return {"station": {"n_seen": n, "m_seen": m, **timed, "warnings": list(warnings)}}


@contextmanager
def open_station(scenario: Scenario, key: Path | None = None) -> Iterator[Station]:
    """The remote station's side, its frames signed with a key."""
    with Codec(STATION_SYSTEM, STATION_COMPONENT, key) as codec:
        yield Station(station_config(scenario), clock=time.monotonic_ns, codec=codec)
