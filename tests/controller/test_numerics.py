"""Sound numerics: covariances stay covariances, angles stay angles, nothing raises."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_control import (
    ESTIMATORS,
    InForce,
    Measured,
    RobotModel,
    StationConfig,
    constant_delay,
    replay,
)
from laglab_control.estimators.kalman import Belief, correct
from laglab_protocol import Command, Measurement, Sender, Tick, frames_in
from laglab_station import Station

ROBOT = RobotModel()
OPTIMAL = ["ekf", "delayed-ekf"]
FILTERS = ["ekf", "popf", "popf-printed", "popf-exact", "delayed-ekf"]


def drive(ticks, start, seed=3):
    """A robot that turns about; its inputs (N, 2) and noisy measurements (N+1, 3)."""
    random = np.random.default_rng(seed)
    inputs = random.normal(size=(ticks, 2)) * [1.0, 3.0] + [0.0, 0.5]
    poses = [np.array(start)]
    for u in inputs:
        poses.append(ROBOT.f(poses[-1], u))
    return inputs, np.array(poses) + random.normal(size=(ticks + 1, 3)) * [0.1, 0.1, 0.13]


def is_covariance(P, least=0.0):
    """Symmetric to the last bit, and no eigenvalue below `least`."""
    return np.array_equal(P, P.T) and np.linalg.eigvalsh(P)[0] >= least


@pytest.mark.slow
@pytest.mark.timeout(180)
def test_the_ekf_keeps_its_covariance_for_a_million_ticks():
    """predict and correct are those of `ekf` and of `delayed-ekf`; every fifth tick measures."""
    inputs, measurements = drive(1000, (0.0, 0.0, 0.0))
    belief = Belief(measurements[0], np.eye(3) * 1e-3)
    z = np.zeros(3)
    for _ in range(1000):
        for k, u in enumerate(inputs):
            belief = Belief(*ROBOT.predict(*belief, u))
            if k % 5 == 0:
                belief = correct(ROBOT, belief, z).posterior
        assert is_covariance(belief.P)
        assert np.linalg.eigvalsh(belief.P)[0] > 0
    assert np.all(np.isfinite(belief.x))


@pytest.mark.parametrize("name", OPTIMAL)
@pytest.mark.parametrize("m", [0, 20])
def test_covariances_stay_positive_definite(name, m):
    inputs, measurements = drive(3000, (1.0, 2.0, 3.0))
    answer = replay(
        ESTIMATORS[name].make(ROBOT),
        measurements[0],
        np.eye(3) * 1e-3,
        inputs,
        constant_delay(measurements, m),
    )
    assert all(is_covariance(P) and np.linalg.eigvalsh(P)[0] > 0 for P in answer.covariances)


@pytest.mark.parametrize("name", [name for name in FILTERS if name not in OPTIMAL])
def test_the_others_stay_symmetric(name):
    inputs, measurements = drive(1000, (1.0, 2.0, 3.0))
    arrivals = constant_delay(measurements, 10)
    answer = replay(
        ESTIMATORS[name].make(ROBOT), measurements[0], np.eye(3) * 1e-4, inputs, arrivals
    )
    for P in answer.covariances[~np.isnan(answer.covariances[:, 0, 0])]:
        np.testing.assert_array_equal(P, P.T)


@pytest.mark.parametrize("name", FILTERS)
@pytest.mark.parametrize("turns", [1, -1, 5000])
def test_whole_turns_change_nothing_but_the_heading(name, turns):
    """Also where the heading comes over +-pi, and when it has thousands of turns behind it."""
    start, whole = np.array([0.0, 0.0, math.pi - 0.1]), np.array([0.0, 0.0, turns * math.tau])
    inputs, measurements = drive(300, start)
    arrivals = constant_delay(measurements, 5)
    estimator = ESTIMATORS[name].make(ROBOT)
    plain, turned = (
        replay(estimator, x, np.eye(3) * 1e-4, inputs, arrivals).estimates
        for x in (start, start + whole)
    )
    assert np.abs(turned - plain - whole).max() < 1e-7


@pytest.mark.parametrize("name", FILTERS)
def test_a_sensor_that_wraps_its_heading_makes_no_difference(name):
    start = np.array([0.0, 0.0, math.pi])
    inputs, measurements = drive(300, start)
    wrapped = measurements.copy()
    wrapped[:, 2] = np.angle(np.exp(1j * wrapped[:, 2]))
    assert np.ptp(wrapped[:, 2]) > 6
    estimator = ESTIMATORS[name].make(ROBOT)
    plain, other = (
        replay(estimator, start, np.eye(3) * 1e-4, inputs, constant_delay(z, 5)).estimates
        for z in (measurements, wrapped)
    )
    assert np.abs(plain - other).max() < 1e-10


zero_or_not = st.sampled_from([0.0, 1e-12, 1e-3, 1.0])
diagonal = st.tuples(zero_or_not, zero_or_not, zero_or_not).map(np.diag)


@settings(max_examples=60)
@given(
    st.sampled_from(OPTIMAL), diagonal, diagonal, st.sampled_from([0.0, 0.01]), st.integers(0, 4)
)
def test_noise_and_prior_of_zero_in_any_component(name, P_0, R, wheel_noise, m):
    model = RobotModel(Q=np.eye(2) * wheel_noise, R=R)
    inputs, _ = drive(60, (0.0, 0.0, 0.0))
    start = np.array([0.3, -0.2, 0.1])
    poses = [start]
    for u in inputs:
        poses.append(model.f(poses[-1], u))
    answer = replay(
        ESTIMATORS[name].make(model), start, P_0, inputs, constant_delay(np.array(poses), m)
    )
    if name == "delayed-ekf" or m == 0:
        assert np.abs(answer.estimates - poses).max() < 1e-6
    assert all(is_covariance(P, least=-1e-12) for P in answer.covariances)


anything = st.floats(allow_nan=True, allow_infinity=True)
vectors = st.tuples(anything, anything, anything).map(np.array)


@settings(max_examples=150)
@given(
    st.sampled_from(FILTERS),
    st.lists(st.tuples(vectors, st.integers(0, 3)), max_size=6),
    st.lists(st.tuples(anything, anything).map(np.array), min_size=6, max_size=6),
)
def test_no_float_makes_a_filter_raise(name, measurements, inputs):
    estimator = ESTIMATORS[name].make(ROBOT)
    with np.errstate(all="ignore"):
        state = estimator.start(np.zeros(3), np.eye(3) * 1e-3)
        for k, u in enumerate(inputs, start=1):
            state = estimator.predict(state, u)
            arrived = [Measured(max(k - late, 0), z) for z, late in measurements[k - 1 : k]]
            state = estimator.correct(state, arrived, [InForce(k - 1, inputs[-k])])
            assert state.x.shape == (3,)
            assert state.P.shape == (3, 3)


@settings(max_examples=100)
@given(st.sampled_from(list(ESTIMATORS)), st.lists(st.tuples(vectors, anything, anything)))
def test_no_float_makes_a_station_raise(name, measured):
    """By wire; it goes on or ends the run as diverged, and never commands anything not finite."""
    station, robot = Station(StationConfig(estimator=name)), Sender(1, 1)
    for k, (z, v, omega) in enumerate(measured):
        measurement = Measurement(*z, v, omega, k, k - 1)
        said = station.hear(frames_in(robot.frame(measurement) + robot.frame(Tick(k, 1))))
        for frame in frames_in(b"".join(said)):
            if isinstance(frame.message, Command):
                assert all(map(math.isfinite, frame.message.speeds))
