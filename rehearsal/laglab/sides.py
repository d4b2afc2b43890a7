"""The two sides of a rehearsal, each made from the scenario alone."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from laglab.scenario import Scenario
from laglab_controller import Law, RobotModel, StationConfig
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import (
    IDEAL,
    Direction,
    Fates,
    FmuPlant,
    Gateway,
    GatewayConfig,
    Link,
    Outcome,
    Patience,
    RandomFates,
    RecordedFates,
    Recorder,
    Relay,
    Watch,
    read_link_log,
    serve_lockstep,
    serve_realtime,
    serve_remote,
)
from laglab_protocol import Endpoint, open_endpoint


def robot_parameters(scenario: Scenario) -> RobotParameters:
    """The robot that the FMU simulates."""
    return RobotParameters(
        wheel_radius=scenario.wheel_radius,
        track=scenario.track,
        sample_time=scenario.sample_time,
        wheel_noise_variance=scenario.wheel_noise_variance,
        measurement_variance=scenario.measurement_variance,
        start=scenario.start,
        seed=scenario.seed,
        noise=scenario.noise,
        wheel_speed_max=scenario.wheel_speed_max,
        motor_time_constant=scenario.motor_time_constant,
        wheel_radius_error=scenario.wheel_radius_error,
        track_error=scenario.track_error,
        wheel_slip=scenario.wheel_slip,
    )


def gateway_config(scenario: Scenario) -> GatewayConfig:
    """What the link and the robot's side do."""
    return GatewayConfig(
        command_delay=scenario.command_delay,
        measurement_delay=scenario.measurement_delay,
        last_tick=scenario.last_tick,
        sample_time=scenario.sample_time,
        safety=scenario.safety,
    )


@contextmanager
def open_gateway(scenario: Scenario) -> Iterator[Gateway]:
    """The robot's side, its FMU loaded until the context ends."""
    parameters = robot_parameters(scenario)
    with Robot.open(scenario.fmi, parameters) as robot:
        plant = FmuPlant(robot, parameters)
        yield Gateway(plant, gateway_config(scenario), link_fates(scenario))


DIRECTIONS: tuple[Direction, ...] = ("command", "measurement")


def link_fates(scenario: Scenario) -> dict[Direction, Fates]:
    """What decides over the frames of each direction that is not ideal, seeded by the scenario."""
    if scenario.link.replay is not None:
        log = Path(scenario.link.replay)
        return {direction: RecordedFates(read_link_log(log, direction)) for direction in DIRECTIONS}
    fates: dict[Direction, Fates] = {}
    for number, direction in enumerate(DIRECTIONS):
        impairments = getattr(scenario.link, direction)
        events = [event for event in scenario.link.event if event.concerns(direction)]
        if impairments != IDEAL or events:
            rng = np.random.default_rng((scenario.seed, number))
            fates[direction] = RandomFates(impairments, events, rng)
    return fates


def serve(
    scenario: Scenario,
    gateway: Gateway,
    endpoint: Link,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
) -> tuple[Outcome, dict[str, Any]]:
    """Run the robot's side at the scenario's pace: how it ended, and what the stamps tell."""
    watch = Watch(gateway.services, [])
    if scenario.pace == "lockstep":
        outcome = serve_lockstep(gateway, endpoint, recorder, patience, watch, progress)
        return outcome, {"link": gateway.audit.report()}
    period = scenario.sample_time / scenario.speed
    outcome, lateness = serve_realtime(
        gateway, endpoint, recorder, patience, watch, progress, period
    )
    return outcome, {"link": gateway.audit.report(), "timing": lateness.report()}


def serve_real(
    scenario: Scenario,
    robot: Endpoint,
    endpoint: Endpoint,
    recorder: Recorder,
    patience: Patience,
    progress: Callable[[int], None],
) -> tuple[Outcome, dict[str, Any]]:
    """Be the link in front of a real robot, at its own pace; as `serve`."""
    relay = Relay(gateway_config(scenario), link_fates(scenario))
    watch = Watch(relay.services, [])
    outcome = serve_remote(relay, robot, endpoint, recorder, patience, watch, progress)
    return outcome, {"link": relay.audit.report()}


Serve = Callable[
    [Endpoint, Recorder, Patience, Callable[[int], None]], tuple[Outcome, dict[str, Any]]
]
"""`serve` or `serve_real`, given all but what is on the station's side."""


@contextmanager
def open_robot(scenario: Scenario, plant: str | None) -> Iterator[Serve]:
    """The robot's side: the FMU, or the real robot at the address `plant`."""
    if plant is None:
        with open_gateway(scenario) as gateway:
            yield partial(serve, scenario, gateway)
    else:
        with open_endpoint(plant) as robot:
            yield partial(serve_real, scenario, robot)


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
