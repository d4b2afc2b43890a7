"""`calibrating-ekf` beside a plain EKF of x and b, and on robots that are not as told."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import laglab
from laglab_control import (
    CalibratingEkf,
    Controller,
    InForce,
    Measured,
    RobotModel,
    Taken,
    WheelScales,
    constant_delay,
    replay,
)

ROBOT = RobotModel(Q=np.diag([0.02, 0.005]))
Ts, L = ROBOT.sample_time, ROBOT.track
START = np.array([-1.0, 0.5, 0.3])
P0 = np.diag([1e-3, 2e-3, 3e-3])
TICKS = 120


@dataclass(frozen=True)
class GyroBias:
    """b = [omega_0]: the robot turns, whatever it is told, by so much more [rad/s]."""

    names: tuple[str] = ("gyro bias",)
    deviations: tuple[float] = (0.3,)

    def taken(self, u, b):
        v, omega = u.tolist()
        return Taken(v, omega + b[0], ((0.0, 1.0),))

    def walk(self, u):
        return (1e-4,)


PARAMETERS = [WheelScales(L), GyroBias()]


def f(x, u, parameters):
    """The pose a tick later, from [x, y, theta, b ...]."""
    v, omega, _ = parameters.taken(u, x[3:])
    return ROBOT.f(x[:3], np.array([v, omega]))


def jacobian(x, u, parameters):
    """df/dx by central differences."""
    step = 1e-6 * np.eye(len(x))
    return np.array([f(x + d, u, parameters) - f(x - d, u, parameters) for d in step]).T / 2e-6


def predict(x, P, u, parameters, walks=True):
    F, Q = np.eye(len(x)), np.zeros(P.shape)
    F[:3] = jacobian(x, u, parameters)
    W = ROBOT.W(x[:3])
    Q[:3, :3] = W @ ROBOT.Q @ W.T
    Q[3:, 3:] = walks * Ts * np.diag(parameters.walk(u))
    return np.append(f(x, u, parameters), x[3:]), F @ P @ F.T + Q


def correct(x, P, z):
    H = np.eye(3, len(x))
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + ROBOT.R)
    return x + K @ ROBOT.innovation(z, x[:3]), (np.eye(len(x)) - K @ H) @ P


def plain_ekf(parameters, inputs, measurements):
    """Pose and parameters at the end of all inputs, the parameters as of the newest measurement."""
    deviations = np.array(parameters.deviations)
    x, P = np.append(START, 0 * deviations), np.diag([*np.diag(P0), *deviations**2])
    newest = max(measurements, default=0)
    for k in range(len(inputs) + 1):
        if k:
            x, P = predict(x, P, inputs[k - 1], parameters, walks=k <= newest)
        if k in measurements:
            x, P = correct(x, P, measurements[k])
    return x, P


def make_record(parameters, b, seed=1, ticks=TICKS):
    """A drive of a robot with parameters b: inputs (N, 2), poses and measurements (N+1, 3)."""
    random = np.random.default_rng(seed)
    turns = np.linspace(0, ticks / 20, ticks)
    inputs = np.stack([0.6 + 0.4 * np.cos(turns), 1.5 * np.sin(turns)], axis=1)
    poses = [START]
    for u in inputs:
        poses.append(f(np.append(poses[-1], b), u, parameters))
    noise = random.normal(size=(ticks + 1, 3)) * np.sqrt(np.diag(ROBOT.R))
    return inputs, np.array(poses), np.array(poses) + noise


def assert_same(x, P, other_x, other_P, deviations=1e-8):
    sigma = np.sqrt(np.diag(other_P))
    assert np.abs((x - other_x) / sigma).max() < deviations
    assert np.abs((P - other_P) / np.outer(sigma, sigma)).max() < deviations


@pytest.mark.parametrize("parameters", PARAMETERS)
@settings(max_examples=20)
@given(delays=st.lists(st.one_of(st.none(), st.integers(0, 40)), min_size=1, max_size=40))
def test_it_is_the_plain_ekf_of_pose_and_parameters(parameters, delays):
    """Whatever is lost or late, and in whatever order it comes. None is a loss."""
    inputs, _, z = make_record(parameters, [0.1] * len(parameters.deviations), ticks=60)
    arrivals = [[] for _ in z]
    for s, sample in enumerate(z):
        delay = delays[s % len(delays)]
        if delay is not None and s + delay < len(z):
            arrivals[s + delay].append(Measured(s, sample))
    estimator = CalibratingEkf(ROBOT, parameters)
    state, had = estimator.start(START, P0), {}
    for k, arrived in enumerate(arrivals):
        state = estimator.predict(state, inputs[k - 1]) if k else state
        state = estimator.correct(state, arrived)
        had |= dict(arrived)
        if k % 20 == 0:
            x, P = plain_ekf(parameters, inputs[:k], had)
            assert_same(*state.parameters, x[3:], P[3:, 3:])
            close = 1e-8 if k in had else 0.02  # the window is linearised a little beside b
            assert_same(state.x, state.P, x[:3], P[:3, :3], close)


@pytest.mark.parametrize("parameters", PARAMETERS)
def test_a_wrong_input_is_put_right(parameters):
    inputs, _, z = make_record(parameters, [0.1] * len(parameters.deviations))
    estimator = CalibratingEkf(ROBOT, parameters)
    state = estimator.start(START, P0)
    for k, arrived in enumerate(constant_delay(z, 20)):
        wrong = np.zeros(2) if k == 50 else inputs[k - 1]
        state = estimator.predict(state, wrong) if k else state
        told = [InForce(49, inputs[49])] if k == TICKS else []
        state = estimator.correct(state, arrived, told)
    x, P = plain_ekf(parameters, inputs, dict(enumerate(z[: TICKS - 20 + 1])))
    assert_same(*state.parameters, x[3:], P[3:, 3:])
    assert_same(state.x, state.P, x[:3], P[:3, :3], 0.02)


@pytest.mark.parametrize("parameters", PARAMETERS)
def test_its_model_is_linearised_as_it_is(parameters):
    model = CalibratingEkf(ROBOT, parameters).model
    x, u = np.array([1.0, 2.0, 0.7, *[0.1, -0.05][: len(parameters.deviations)]]), np.array([1, -2])
    assert np.abs(model.A(x, u)[:3] - jacobian(x, u, parameters)).max() < 1e-9
    np.testing.assert_array_equal(model.A(x, u)[3:], np.eye(len(x))[3:])


@pytest.mark.parametrize(("v", "omega"), [(-0.5, 0.0), (0.5, 0.0), (0.0, 1.0), (0.0, -1.0)])
def test_a_wheel_s_scale_wanders_as_far_as_it_turns_either_way(v, omega):
    left, right = WheelScales(L, wander=0.03).walk(np.array((v, omega)))
    assert left == pytest.approx(0.03**2 * abs(v - L / 2 * omega))
    assert right == pytest.approx(0.03**2 * abs(v + L / 2 * omega))


@pytest.mark.parametrize(
    ("parameters", "b"), [(WheelScales(L), [0.1, -0.05]), (GyroBias(), [-0.4])]
)
def test_the_parameters_are_found(parameters, b):
    """As surely as the claimed covariance says, and with them the pose."""
    inputs, poses, z = make_record(parameters, b, ticks=600)
    estimator = CalibratingEkf(ROBOT, parameters)
    state = estimator.start(START, P0)
    for k, arrived in enumerate(constant_delay(z, 20)):
        state = estimator.correct(estimator.predict(state, inputs[k - 1]) if k else state, arrived)
    found, P = state.parameters
    assert np.all(np.abs(found - b) < 4 * np.sqrt(np.diag(P)))
    assert np.all(np.sqrt(np.diag(P)) < np.array(parameters.deviations) / 2)
    assert np.all(np.abs(state.x - poses[-1]) < 4 * np.sqrt(np.diag(state.P)))


def test_a_long_delay_costs_no_accuracy():
    """At m = 400 a window of 4 s is linearised piece by piece, and ends where the robot is."""
    parameters = WheelScales(L, wander=0.0)
    inputs, poses, _ = make_record(parameters, [0.1, 0.1], ticks=1200)
    answer = replay(
        CalibratingEkf(ROBOT, parameters), START, P0, inputs, constant_delay(poses, 400)
    )
    assert np.abs(answer.estimates[-1] - poses[-1]).max() < 0.01


def test_to_be_told_what_was_believed_moves_nothing():
    """The inputs since the newest measurement are put right at the b that is known by then."""
    parameters = WheelScales(L, wander=0.0)
    inputs, poses, _ = make_record(parameters, [0.1, 0.1], ticks=1200)
    estimator = CalibratingEkf(ROBOT, parameters)
    state = estimator.start(START, P0)
    for k, arrived in enumerate(constant_delay(poses, 400)):
        state = estimator.correct(estimator.predict(state, inputs[k - 1]) if k else state, arrived)
    told = estimator.correct(state, [], [InForce(1000, inputs[1000])])
    assert_same(told.x, told.P, state.x, state.P, 0.01)


def test_begun_again_it_keeps_what_it_has_learned():
    parameters = WheelScales(L)
    inputs, _, z = make_record(parameters, [0.1, 0.1])
    estimator = CalibratingEkf(ROBOT, parameters)
    state = estimator.start(START, P0)
    for k, u in enumerate(inputs):
        state = estimator.correct(estimator.predict(state, u), [Measured(k + 1, z[k + 1])])
    again = estimator.restart(state, START, P0)
    assert again.tick == 0
    np.testing.assert_array_equal(again.x, START)
    np.testing.assert_allclose(again.P, P0, atol=1e-18)
    np.testing.assert_array_equal(again.parameters.x, state.parameters.x)
    np.testing.assert_array_equal(again.parameters.P, state.parameters.P)
    way = estimator.calibrated(again, ROBOT).way(np.array([1.0, 0.0]))
    assert way.x == pytest.approx(Ts * (1 + state.parameters.x.mean()))


class Keeping(Controller):
    """Keeps what it answers."""

    def answer(self, *said):
        self.kept.append(super().answer(*said))
        return self.kept[-1]


def kept_run(scenario, estimator, overrides):
    """A run, without the guard where nothing else is said, and its controller, which keeps all."""
    made = []

    def make(config):
        made.append(Keeping(config))
        object.__setattr__(made[-1], "kept", [])
        return made[-1]

    told = {"estimator.kind": estimator, "estimator.guard": False} | overrides
    run = laglab.run(scenario, told, controller=make)
    return run, made[-1]


@pytest.mark.parametrize("error", [0.1, -0.1])
def test_wheels_that_are_not_as_believed_are_found_out(error):
    overrides = {"plant.wheel_radius_error": error, "estimator.guard": True}
    run, _ = kept_run("lab", "calibrating-ekf", overrides)
    assert run.summary.converged
    found = run.summary.station.calibration
    assert [each.name for each in found] == ["left wheel", "right wheel"]
    assert all(abs(each.value - error) < 4 * each.deviation < 0.12 for each in found)


@pytest.mark.parametrize("error", [0.1, -0.1])
def test_a_track_that_is_not_as_believed_does_no_harm(error):
    """Two wheels cannot tell it, but what they tell of each turn is nearly as good."""
    overrides = {"plant.track_error": error}
    ours, other = (
        kept_run("lab", name, overrides)[0].summary for name in ("calibrating-ekf", "delayed-ekf")
    )
    assert ours.converged
    assert ours.rms_error.theta < other.rms_error.theta / 2


def test_what_was_learned_is_used_for_the_commands_in_flight():
    """x^_{k+n} is where the robot is n ticks later, on 10 % larger wheels."""
    n, quiet = 30, (1e-6, 1e-6, 1e-6)
    overrides = {
        "plant.wheel_radius_error": 0.1,
        "plant.measurement_variance": quiet,
        "plant.wheel_noise_variance": 1e-6,
        "link.command_delay": n,
        "duration": 4.0,
    }
    apart = {}
    for name in ("calibrating-ekf", "delayed-ekf"):
        run, controller = kept_run("lab", name, overrides | {"estimator.guard": False})
        said = np.array([controller.at_arrival(control).x for control in controller.kept])
        true = np.stack([run.trace[column] for column in ("x", "y", "theta")], axis=1)
        apart[name] = np.abs(said[200:-n] - true[200 + n :])[:, :2].max()
    assert apart["calibrating-ekf"] < 0.003
    assert apart["delayed-ekf"] > 0.02


def test_a_robot_with_lagging_motors_is_no_worse_off():
    """`lab-real`: the wheels saturate, the motors lag, and no scale describes either."""
    errors = {}
    for name in ("calibrating-ekf", "delayed-ekf"):
        summaries = [kept_run("lab-real", name, {"seed": seed})[0].summary for seed in (1, 2)]
        assert all(summary.converged for summary in summaries)
        each = [(s.rms_error.x, s.rms_error.y, s.rms_error.theta) for s in summaries]
        errors[name] = np.mean(each, axis=0)
    assert np.all(errors["calibrating-ekf"] < errors["delayed-ekf"])
