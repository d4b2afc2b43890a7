"""What a controller claims at a tick, and of whom it asks it."""

import numpy as np
import pytest

from laglab_control import Control, Controller, Echo, Measured, StationConfig
from laglab_control.doubt import PATIENCE, doubt

N = 2


def silent(name: str, ticks: int) -> tuple[Controller, Control]:
    """After a tick that told all, nothing came for so many."""
    config = StationConfig(name, initial_estimate=(-2.0, -1.0, 0.3), command_delay=N)
    controller = Controller(config)
    control = controller.answer(controller.start(), [])
    for k in range(1, 20 + ticks):
        control = controller.advance(control)
        made = k - 1 - N if k > N else None
        told = [Echo(k - 1, np.array((0.5, 0.1)), made)] if k < 20 else []
        seen = [Measured(k, np.array((-2.0, -1.0, 0.3)))] if k < 20 else []
        control = controller.answer(control, seen, told)
    return controller, control


@pytest.mark.parametrize(("ticks", "doubted"), [(PATIENCE, False), (PATIENCE + 20, True)])
def test_what_is_not_known_of_the_inputs_is_claimed_beside_what_the_estimator_claims(
    ticks: int, doubted: bool
) -> None:
    controller, control = silent("delayed-ekf", ticks)
    assert control.pose is not None
    assert control.P is not None
    unknown = doubt(control.flight, controller.config.model, control.pose)
    assert (unknown is not None) is doubted
    expected = control.estimate.P + (unknown if unknown is not None else 0.0)
    np.testing.assert_array_equal(control.P, expected)
    if doubted:
        assert control.P[0, 0] > 2 * control.estimate.P[0, 0]


@pytest.mark.parametrize("ticks", [1, PATIENCE + 20])
def test_who_claims_nothing_is_not_made_to(ticks: int) -> None:
    controller, control = silent("raw", ticks)
    assert control.pose is not None
    assert control.P is None
    assert controller.at_arrival(control) is None
    assert controller.gated(control) == 0


@pytest.mark.parametrize(("name", "learns"), [("delayed-ekf", True), ("popf", False)])
def test_only_where_the_same_is_learned_besides_does_one_that_learns_stand_ready(
    name: str, learns: bool
) -> None:
    controller = Controller(StationConfig(name, guard=True))
    assert (controller.kind.learner is not None) is learns
    assert controller._guard is not None
    assert (controller._guard.learner is not None) is learns
