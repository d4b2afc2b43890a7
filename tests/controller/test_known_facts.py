"""The facts of docs/theory.md, each found again in a loop around the real controller."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from laglab_control import Controller, Measured, PolarLaw, SpeedLimits, StationConfig

FIG7 = {"start": (-1.5, -2.0, np.pi / 2), "n": 15, "m": 25}


def test_fig4_converges(simulate):
    assert simulate("raw", n=0, m=0).converged()


def test_fig5_with_its_limits_goes_near_but_its_heading_does_not_settle(simulate):
    record = simulate("raw", limits=SpeedLimits(v_max=2.0, omega_max=1.7))
    assert not record.converged()
    assert np.hypot(*record.poses[-1, :2]) < 0.06
    assert np.ptp(record.poses[-200:, 2]) > 0.3
    assert np.abs(record.inputs[-200:, 1]).max() == 1.7


def test_fig5_without_limits_diverges(simulate):
    assert np.nanmax(np.abs(simulate("raw").inputs[:, 0])) > 100


@pytest.mark.parametrize("case", [{}, FIG7], ids=["fig6", "fig7"])
def test_fig6_and_fig7_converge_to_the_goal_itself(simulate, case):
    record = simulate("popf", **case)
    assert record.converged()
    assert np.abs(record.poses[-1]).max() < 1e-5


def test_fig8_popf_deviates_less_than_ekf(simulate):
    popf = simulate("popf", noise=1)
    ekf = simulate("ekf", noise=1)
    assert np.all(popf.rms_error() < ekf.rms_error())


def test_popf_printed_is_wrong_even_without_noise(simulate):
    record = simulate("popf-printed")
    assert not record.converged()
    assert record.rms_error() == pytest.approx([0.15, 0.18, 0.04], abs=0.005)


@pytest.mark.parametrize(
    ("estimator", "p0", "at_most"), [("popf", 1e-4, 0.009), ("delayed-ekf", 1e-3, 0.011)]
)
def test_rms_error_in_x_over_three_seeds(simulate, estimator, p0, at_most):
    rms = [simulate(estimator, noise=seed, p0=p0).rms_error()[0] for seed in range(3)]
    assert np.mean(rms) < at_most


def test_popf_diverges_on_a_large_prior_where_delayed_ekf_does_not(simulate):
    assert np.isnan(simulate("popf", noise=1, p0=2e-3).poses[-1, 0])
    assert simulate("delayed-ekf", noise=1, p0=5e-3).rms_error()[0] < 0.02


@settings(
    max_examples=40,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(n=st.integers(0, 30), m=st.integers(0, 30), name=st.sampled_from(["popf", "delayed-ekf"]))
def test_delays_are_exact_for_every_pair(simulate, n, m, name):
    """One tick out in n or m, and a moving robot's estimate would not be exact."""
    record = simulate(name, n=n, m=m, ticks=n + m + 30)
    assert np.abs(record.estimates - record.poses).max() < 1e-12


@pytest.mark.parametrize("n", [0, 1, 10])
def test_the_command_is_made_for_the_moment_it_comes_into_force(n):
    """Without noise the law must see the pose of n ticks later (29)."""
    start, law = (-2.0, -1.0, 0.4), PolarLaw()
    config = StationConfig(estimator="popf", law=law, initial_estimate=start, command_delay=n)
    controller = Controller(config)
    control = controller.answer(controller.start(), [])
    sent = [np.zeros(2)] * n
    poses = [np.array(start)]
    for k in range(60):
        sent.append(np.array(control.drive[:2]))
        poses.append(config.model.f(poses[k], sent[k]))
        control = controller.answer(controller.advance(control), [Measured(k + 1, poses[k + 1])])
    for k in range(60 - n):
        v, omega, _ = law.drive(poses[k + n], (k + n) * 0.01, None)
        assert sent[k + n] == pytest.approx([v, omega], abs=1e-9)


@pytest.mark.parametrize("p0", [1e-4, 2e-3, 1e-2])
def test_popf_exact_does_not_diverge_but_is_not_the_optimum(simulate, p0):
    exact, optimum = (simulate(name, noise=2, p0=p0) for name in ("popf-exact", "delayed-ekf"))
    assert np.abs(exact.estimates - exact.poses).max() < 1
    if p0 > 1e-3:
        assert exact.rms_error()[0] > 2 * optimum.rms_error()[0]
