"""Any filter that knows nothing of delays, run again from where a measurement belongs."""

import numpy as np
import pytest

from laglab_control import (
    Backdated,
    DelayedEkf,
    InForce,
    Measured,
    PluginFailedError,
    RigidMotions,
    RobotModel,
    replay,
)

MODEL = RobotModel()
X, P = np.array([1.0, 2.0, 0.5]), np.diag([0.1, 0.2, 0.3])
U = np.array([0.4, -0.3])


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


def after(ticks, u=U):
    """Nothing measured meanwhile."""
    state = Plain(MODEL).start(X, P)
    for _ in range(ticks):
        state = Plain(MODEL).predict(state, u)
    return state


def test_what_is_older_than_it_keeps_is_not_used():
    """The 256 ticks before the present one are."""
    state = after(300)
    assert len(state.past) == 257
    assert Plain(MODEL).correct(state, [Measured(43, X)], [InForce(43, 2 * U)]) is state
    assert np.any(Plain(MODEL).correct(state, [Measured(44, X)]).x != state.x)
    x = X
    for k in range(300):
        x = MODEL.f(x, 2 * U if k == 44 else U)
    right = Plain(MODEL).correct(state, [], [InForce(44, 2 * U)])
    np.testing.assert_allclose(right.x, x, rtol=0, atol=1e-13)


def test_what_is_in_force_from_now_on_is_told_by_predict():
    state = after(3)
    assert Plain(MODEL).correct(state, [], [InForce(3, U)]) is state


def test_a_measurement_of_tick_0_and_its_repeat():
    """At once: x+ = x + P (P + R)^-1 (z - x), P+ = P - P (P + R)^-1 P; S = P + R."""
    begun = Plain(MODEL).start(X, P)
    assert Plain(MODEL).innovation(begun) is None
    v = np.array([0.1, -0.2, 0.3])
    z = X + v + np.array([0, 0, 2 * np.pi])
    state = Plain(MODEL).correct(begun, [Measured(0, z)])
    p, r = np.diag(P), np.diag(MODEL.R)
    np.testing.assert_allclose(state.x, X + p / (p + r) * v, rtol=0, atol=1e-14)
    np.testing.assert_allclose(state.P, np.diag(p - p / (p + r) * p), rtol=0, atol=1e-14)
    value, S = Plain(MODEL).innovation(state)
    np.testing.assert_allclose(value, v, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(S, P + MODEL.R)
    assert Plain(MODEL).correct(state, [Measured(0, z + 1)]) is state
    assert state.tick == 0


def test_the_innovation_is_that_of_the_newest_measurement_of_those_that_came():
    """With the prior that the older one left: x^-_2 = f(f(x+_1)), all of it by hand."""
    model, plain = MODEL, Plain(MODEL)
    x, covariance = model.predict(X, P, U)
    x, covariance = plain.corrected(x, covariance, X)
    x, covariance = model.predict(x, covariance, U)
    state = plain.correct(after(4), [Measured(2, 2 * X), Measured(1, X)])
    v, S = plain.innovation(state)
    np.testing.assert_allclose(v, 2 * X - x, rtol=0, atol=1e-14)
    np.testing.assert_allclose(S, covariance + model.R, rtol=0, atol=1e-14)
    assert plain.innovation(plain.correct(state, [], [InForce(0, 2 * U)])) is None
    assert plain.innovation(plain.predict(state, U)) is None


class WithBias(Plain):
    """Beside the pose a fourth component, of which it knows nothing but what it began with."""

    def forward(self, x, P, u):
        P = P.copy()
        pose, P[:3, :3] = super().forward(x[:3], P[:3, :3], u)
        return np.append(pose, x[3]), P

    def corrected(self, x, P, z):
        P = P.copy()
        pose, P[:3, :3] = super().corrected(x[:3], P[:3, :3], z)
        return np.append(pose, x[3]), P


def test_of_a_state_of_more_than_the_pose_the_pose_is_measured():
    both = []
    larger = np.diag([*np.diag(P), 1.0])
    for kind, x, covariance in ((Plain, X, P), (WithBias, np.append(X, 7.0), larger)):
        state = kind(MODEL).predict(kind(MODEL).start(x, covariance), U)
        both.append(kind(MODEL).correct(state, [Measured(0, 2 * X), Measured(1, 3 * X)]))
    one, other = both
    np.testing.assert_array_equal(other.x, np.append(one.x, 7.0))
    np.testing.assert_array_equal(other.P[:3, :3], one.P)
    for ours, theirs in zip(one.innovation, other.innovation, strict=True):
        np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize(
    ("answer", "told"),
    [
        (None, r"x \(d,\) and P \(d, d\), not None"),
        (([0.0] * 3, P), r"x as an array \(d,\), not \[0.0, 0.0, 0.0\]"),
        ((X[np.newaxis], P), r"x as an array \(d,\), not array\(\[\["),
        ((X, P.tolist()), r"P as an array \(3, 3\), not \[\["),
        ((X, P[:2, :2]), r"P as an array \(3, 3\), not array"),
    ],
)
def test_what_must_be_answered_is_said(answer, told):
    class Wrong(Plain):
        def forward(self, x, P, u):
            return answer

        def corrected(self, x, P, z):
            return answer

    wrong = Wrong(MODEL)
    begun = wrong.start(X, P)
    with pytest.raises(PluginFailedError, match=f"forward must answer {told}"):
        wrong.predict(begun, U)
    with pytest.raises(PluginFailedError, match=f"corrected must answer {told}"):
        wrong.correct(begun, [Measured(0, X)])
