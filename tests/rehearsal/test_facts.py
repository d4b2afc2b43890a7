"""What two components both know, and neither can take from the other."""

import numpy as np

from laglab_control import MEMORY, RobotModel
from laglab_fmu import RobotParameters
from laglab_gateway.memory import KEPT


def test_the_filters_believe_of_the_robot_what_the_fmu_is() -> None:
    """Where the two stand by their defaults, which are the paper's."""
    model, robot = RobotModel(), RobotParameters()
    for name in ("sample_time", "wheel_radius", "track"):
        assert getattr(model, name) == getattr(robot, name), name
    np.testing.assert_array_equal(model.Q, robot.wheel_noise_variance * np.eye(2))
    np.testing.assert_array_equal(model.R, np.diag(robot.measurement_variance))


def test_the_robot_recalls_what_the_station_still_asks_for() -> None:
    assert KEPT == MEMORY


def test_the_defaults_are_the_papers() -> None:
    robot = RobotParameters()
    assert (robot.wheel_radius, robot.track, robot.sample_time) == (0.05, 0.6, 0.01)
    assert (robot.wheel_noise_variance, robot.measurement_variance) == (0.01, (0.01, 0.01, 0.018))
