"""The examples with other people's filters: in the loop, as good as ours, and short."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from laglab_control import Backdated, DelayedEkf, Measured, RigidMotions, RobotModel, replay
from laglab_control.estimators.interface import InForce

EXAMPLES = Path(__file__).parents[2] / "controller" / "examples"
MOST_LINES = 60
MODEL = RobotModel()


def laglab(folder, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "laglab", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(EXAMPLES), "PYTHONDONTWRITEBYTECODE": "1"},
        check=False,
        capture_output=True,
        text=True,
        timeout=100,
    )


@pytest.mark.timeout(120)
@pytest.mark.parametrize("name", ["filterpy_ukf:Ukf", "stonesoup_ekf:StoneSoupEkf"])
def test_it_drives_the_robot_beside_our_own_filter(tmp_path, name):
    path = EXAMPLES / f"{name.split(':')[0]}.py"
    assert len(path.read_text().splitlines()) <= MOST_LINES
    filters = ("--estimator", name, "--estimator", "delayed-ekf")
    done = laglab(tmp_path, "run", "lab", *filters, "--duration", "1", "--out", "run")
    assert done.returncode == 0, done.stderr
    trace = np.genfromtxt(tmp_path / "run" / "trace.csv", delimiter=",", names=True)
    ours = np.genfromtxt(tmp_path / "run" / "shadow-delayed-ekf.csv", delimiter=",", names=True)
    for axis in ("x", "y", "theta"):
        assert np.abs(trace[f"{axis}_est"] - ours[axis]).max() < 2e-4


@pytest.mark.slow
@pytest.mark.timeout(240)
@pytest.mark.parametrize("name", ["filterpy_ukf:Ukf", "stonesoup_ekf:StoneSoupEkf"])
def test_it_keeps_the_interface(tmp_path, name):
    checked = laglab(tmp_path, "check", name)
    assert checked.returncode == 0, checked.stdout


class Plain(Backdated):
    """The EKF of our own model."""

    def forward(self, x, P, u):
        return self.model.predict(x, P, u)

    def corrected(self, x, P, z):
        K = P @ np.linalg.inv(P + self.model.R)
        return x + K @ self.model.innovation(z, x), P - K @ P


def test_backdated_is_delayed_ekf_over_late_and_lost_measurements_and_wrong_inputs():
    random, ticks = np.random.default_rng(4), 400
    inputs = random.normal(size=(ticks, 2))
    poses = [np.zeros(3)]
    for u in inputs:
        poses.append(MODEL.f(poses[-1], u))
    z = np.array(poses) + random.normal(size=(ticks + 1, 3)) * 0.1
    arrivals = [[] for _ in range(ticks + 1)]
    for s in range(ticks):
        if random.random() < 0.8:
            arrivals[min(s + random.integers(0, 60), ticks)].append(Measured(s, z[s]))
    prior = np.zeros(3), 1e-3 * np.eye(3)
    ours, others = (
        replay(estimator, *prior, inputs, arrivals)
        for estimator in (DelayedEkf(MODEL, RigidMotions(MODEL)), Plain(MODEL))
    )
    assert np.abs(ours.estimates - others.estimates).max() < 1e-10
    assert np.abs(ours.covariances - others.covariances).max() < 1e-10
    states = []
    for estimator in (DelayedEkf(MODEL, RigidMotions(MODEL)), Plain(MODEL)):
        state = estimator.start(*prior)
        for k in range(40):
            state = estimator.correct(state, [Measured(k, z[k])] if k % 3 == 0 else [])
            state = estimator.predict(state, np.zeros(2))
        told = [InForce(k, inputs[k]) for k in range(10, 30)]
        states.append(estimator.correct(state, [Measured(20, z[20])], told))
    assert states[0].x == pytest.approx(states[1].x, abs=1e-10)
    assert pytest.approx(states[1].P, abs=1e-12) == states[0].P


def test_what_is_older_than_it_keeps_is_not_used():
    state = Plain(MODEL).start(np.zeros(3), np.eye(3))
    for _ in range(300):
        state = Plain(MODEL).predict(state, np.array((0.1, 0.0)))
    assert Plain(MODEL).correct(state, [Measured(3, np.ones(3))]) is state
    assert len(state.past) == 257
