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
    return RobotModel(
        sample_time=scenario.sample_time,
        wheel_radius=scenario.wheel_radius,
        track=scenario.track,
        Q=scenario.wheel_noise_variance * np.eye(2),
        R=np.diag(scenario.measurement_variance),
    )


def station_config(scenario: Scenario) -> StationConfig:
    """The remote station's side."""
    law = Law(
        goal=scenario.goal,
        gamma=scenario.gamma,
        lambda_=scenario.lambda_,
        h=scenario.h,
        v_max=scenario.v_max,
        omega_max=scenario.omega_max,
        goal_tolerance=scenario.goal_tolerance,
    )
    return StationConfig(
        estimator=scenario.estimator,
        model=robot_model(scenario),
        law=law,
        initial_estimate=scenario.first_estimate(),
        initial_covariance=scenario.initial_covariance * np.eye(3),
        command_delay=scenario.command_delay,
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
