"""What a model, a law and a station refuse, and that the refusal names the field."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from laglab_control import (
    FAR,
    ConfigError,
    ControlError,
    PolarLaw,
    RobotModel,
    SpeedLimits,
    StationConfig,
)
from laglab_station import Station

NAN, INF = float("nan"), float("inf")
NOT_POSITIVE = [0.0, -1.0, NAN, INF, -INF, True, "3", [1.0], 10**400]
NO_COVARIANCE = {
    "a negative variance": np.diag([0.1, -0.1, 0.1]),
    "NaN": np.diag([0.1, NAN, 0.1]),
    "infinite": np.diag([0.1, INF, 0.1]),
    "not symmetric": np.array([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    "more correlated than possible": np.array([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    "of another shape": np.eye(2),
    "no numbers": "large",
}


@pytest.mark.parametrize("value", NOT_POSITIVE, ids=repr)
@pytest.mark.parametrize(
    ("made", "field"),
    [
        *((PolarLaw, name) for name in ("gamma", "lambda_", "h", "goal_tolerance")),
        *(
            (SpeedLimits, name)
            for name in ("v_max", "omega_max", "caution", "accel_max", "alpha_max")
        ),
        *((RobotModel, name) for name in ("sample_time", "wheel_radius", "track")),
    ],
)
def test_what_must_be_positive(made, field, value):
    with pytest.raises(
        ConfigError, match=rf"^{field} must be a finite number above 0(, or None)?, not "
    ):
        made(**{field: value})


def test_none_switches_a_limit_off_and_is_no_gain():
    assert SpeedLimits(v_max=None).v_max is None
    with pytest.raises(ConfigError, match="gamma must be a finite number above 0, not None"):
        PolarLaw(gamma=None)


@pytest.mark.parametrize("value", [1, 0.5, np.float64(2.0), np.float32(2.0), Fraction(1, 3)])
def test_any_positive_number_will_do(value):
    assert PolarLaw(gamma=value).gamma == value


@pytest.mark.parametrize("value", [-1, 1.5, 3.0, True, "3", NAN], ids=repr)
def test_a_delay_is_a_number_of_ticks(value):
    said = r"^command_delay must be a whole number of 0 or more, not "
    with pytest.raises(ConfigError, match=said):
        StationConfig(command_delay=value)


@pytest.mark.parametrize("wrong", NO_COVARIANCE.values(), ids=NO_COVARIANCE)
@pytest.mark.parametrize(
    ("made", "field"), [(RobotModel, "R"), (StationConfig, "initial_covariance")]
)
def test_what_is_no_covariance(made, field, wrong):
    with pytest.raises(ConfigError, match=f"^{field} must "):
        made(**{field: wrong})


def test_the_wheels_noise_is_a_covariance_too():
    with pytest.raises(ConfigError, match=r"^Q must be positive semidefinite"):
        RobotModel(Q=-np.eye(2))


@given(arrays(float, (3, 3), elements=st.floats(-10, 10)), st.floats(1e-12, 1e12))
def test_every_covariance_will_do_also_a_singular_one(root, scale):
    P = scale * root @ root.T
    np.testing.assert_array_equal(StationConfig(initial_covariance=P).initial_covariance, P)
    StationConfig(initial_covariance=scale * np.outer(root[0], root[0]))


@pytest.mark.parametrize("wrong", [(NAN, 0.0, 0.0), (0.0, 0.0, INF), (0.0, 0.0), "there"])
def test_a_pose_is_three_finite_numbers(wrong):
    with pytest.raises(ConfigError, match=r"^goal must "):
        PolarLaw(goal=wrong)
    with pytest.raises(ConfigError, match=r"^initial_estimate must "):
        StationConfig(initial_estimate=wrong)


def test_a_start_that_no_run_leads_to_the_goal_from():
    near, beyond = (5000.0 - FAR, 5000.0, 0.0), (5000.0 - FAR - 1.0, 5000.0, 0.0)
    goal = (5000.0, 5000.0, 0.0)
    StationConfig(goal=goal, initial_estimate=near)
    with pytest.raises(ConfigError, match=r"^initial_estimate must be within 1000 m of the goal"):
        StationConfig(goal=goal, initial_estimate=beyond)


def test_who_catches_either_tree_catches_it():
    assert issubclass(ConfigError, ControlError)
    assert issubclass(ConfigError, ValueError)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("estimator", 3),
        ("estimator_options", 3),
        ("model", 3),
        ("law", 3),
        ("law", None),
        ("limits", 3),
        ("guard", "no"),
        ("guard", 1),
    ],
)
def test_what_a_station_is_told_is_of_its_kind(field, value):
    with pytest.raises(ConfigError, match=rf"^{field} must be "):
        StationConfig(**{field: value})


def test_no_more_is_planned_than_a_command_can_tell():
    with pytest.raises(ConfigError, match="plan must be 240 or less, not 241"):
        Station(StationConfig(plan=241))
    assert Station(StationConfig(plan=240)).tick is None
