"""The two sides of a rehearsal, each made from the scenario alone."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from laglab.scenario import Scenario
from laglab_controller import Law, RobotModel, StationConfig
from laglab_fmu import Robot, RobotParameters
from laglab_gateway import FmuPlant, Gateway, GatewayConfig


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
    )


@contextmanager
def open_gateway(scenario: Scenario) -> Iterator[Gateway]:
    """The robot's side, its FMU loaded until the context ends."""
    parameters = robot_parameters(scenario)
    with Robot.open(scenario.fmi, parameters) as robot:
        plant = FmuPlant(robot, parameters)
        config = GatewayConfig(
            command_delay=scenario.command_delay,
            measurement_delay=scenario.measurement_delay,
            last_tick=scenario.last_tick,
            sample_time=scenario.sample_time,
        )
        yield Gateway(plant, config)


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
