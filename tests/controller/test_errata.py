"""Each switch changes what its equation says, and nothing without it."""

import numpy as np
import pytest

from laglab_control import (
    Controller,
    Erratum,
    Measured,
    NonlinearModel,
    Popf,
    PrintedController,
    StationConfig,
    constant_delay,
    replay,
)

CONFIG = StationConfig(
    estimator="popf",
    initial_estimate=(-3, -3, 0.2),
    initial_covariance=np.eye(3) * 1e-2,
    command_delay=3,
)


def drive(controller):
    """30 ticks; measurements 2 ticks late that make the estimate turn and jump."""
    random = np.random.default_rng(1)
    control = controller.answer(controller.start(), [])
    for k in range(1, 31):
        z = Measured(max(k - 2, 0), np.array([-3, -3, 0.2]) + random.normal(size=3) * 0.3)
        control = controller.answer(controller.advance(control), [z])
    return control


def test_without_errata_it_is_the_controller_itself():
    printed, plain = drive(PrintedController(CONFIG)), drive(Controller(CONFIG))
    assert np.allclose(printed.estimate.x, plain.estimate.x, atol=1e-10)
    assert np.allclose(printed.estimate.P, plain.estimate.P, atol=1e-12)


@pytest.mark.parametrize("erratum", sorted(set(Erratum) - {Erratum.COVARIANCE}, key=str))
def test_each_switch_does_something(erratum):
    printed = drive(PrintedController(CONFIG, errata=frozenset({erratum})))
    assert np.abs(printed.estimate.x - drive(Controller(CONFIG)).estimate.x).max() > 1e-7


def test_H_k_or_H_s_is_the_same_for_the_robot_whose_H_is_I():
    printed = drive(PrintedController(CONFIG, errata=frozenset({Erratum.COVARIANCE})))
    assert np.allclose(printed.estimate.P, drive(Controller(CONFIG)).estimate.P, atol=1e-12)


def test_H_k_or_H_s_matters_where_H_is_not_constant():
    model = NonlinearModel(
        f=lambda x, u: x + u,
        A=lambda _x, _u: np.eye(1),
        W=lambda _x, _u: np.eye(1),
        Q=np.eye(1) * 0.01,
        h=lambda x: x**2,
        H=lambda x: 2 * np.diag(x),
        R=np.eye(1),
    )
    inputs, z = np.full((10, 1), 0.5), np.arange(11.0)[:, np.newaxis]
    used, printed = (
        replay(Popf(model, covariance_at_k=k), np.ones(1), np.eye(1), inputs, constant_delay(z, 3))
        for k in (False, True)
    )
    assert np.array_equal(used.covariances[:3], printed.covariances[:3])
    assert not np.allclose(used.covariances[3], printed.covariances[3])
