"""Many robots whose wheels are not alike: the batch, held against the controller of one."""

import numpy as np
import pytest

from laglab_control import Controller, Echo, Measured, RobotModel, StationConfig
from laglab_control.batch import BATCHED, BatchController, Pose
from laglab_control.batch.impaired.guard import _length
from laglab_control.flight import sent_for
from laglab_control.guard.evidence import no_evidence, weighed

N, M, TICKS = 4, 7, 120
STARTS = np.array(((-3.0, -2.0), (-3.0, 1.0), (0.0, 1.5)))


@pytest.mark.parametrize("exact", [True, False])
@pytest.mark.parametrize("estimator", [name for name in BATCHED if name != "raw"])
@pytest.mark.parametrize("wheels", [(0.01, 0.01), (0.01, 0.03)])
def test_the_batch_says_what_each_controller_says(estimator, wheels, exact):
    model = RobotModel(Q=np.diag(wheels))
    configs = [
        StationConfig(estimator, model=model, initial_estimate=start, command_delay=N)
        for start in STARTS.T
    ]
    z = STARTS + 0.1 * np.random.default_rng(1).standard_normal((TICKS, 3, 2))
    batch = BatchController(configs[0], STARTS, M, exact)
    many = batch.start()
    ones = [Controller(each).start() for each in configs]
    for k in range(TICKS):
        if k:
            many = batch.advance(many)
        many = batch.answer(many, Pose(*z[k - M]) if k >= M else None)
        for i, config in enumerate(configs):
            one = _answered(Controller(config), ones[i], z[..., i], k)
            assert np.allclose([row[i] for row in many.pose], one.pose, rtol=0, atol=1e-9)
            P = np.array([row[i] if len(row) > 1 else row[0] for row in many.P])
            assert np.allclose(P, one.P[np.triu_indices(3)], rtol=1e-9, atol=1e-15)
            ones[i] = one


def _answered(controller, control, z, k):
    if k:
        control = controller.advance(control)
    if k < M:
        return controller.answer(control, [])
    s = k - M
    echo = Echo(s, sent_for(control.flight, s), s - N if s >= N else None)
    return controller.answer(control, [Measured(s, z[s])], [echo])


def test_its_guards_look_for_a_drift_when_the_guard_of_one_does():
    evidence = no_evidence()
    for there in range(1, 2000):
        evidence = weighed(evidence, (0.0, 0.0, 0.0), 0.0)
        assert _length(np.array([there]))[0] == evidence.length
