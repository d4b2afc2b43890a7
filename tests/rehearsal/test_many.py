"""Many runs at once are the runs one by one."""

import numpy as np
import pytest

import laglab
from laglab.scenario import load
from laglab.studies.many import Many, run_many

SHARP = 1e-9
QUIET = [
    ("fig4", {}),
    ("fig5", {}),
    ("fig6", {}),
    ("fig7", {}),
    ("fig6", {"estimator.kind": "delayed-ekf", "duration": 4.0}),
    ("fig6", {"link.command_delay": 0, "link.measurement_delay": 0, "duration": 3.0}),
    ("lab", {"noise": False, "duration": 4.0}),
]
NOISY = [
    ("lab", {}),
    ("lab", {"estimator.kind": "popf"}),
    ("lab", {"estimator.kind": "popf-printed", "estimator.guard": False}),
    ("lab", {"estimator.kind": "ekf", "estimator.guard": False}),
    ("lab", {"estimator.kind": "raw", "estimator.guard": False}),
    ("lab", {"link.command_delay": 0, "estimator.kind": "popf"}),
    ("lab", {"link.measurement_delay": 0}),
    ("lab", {"law.accel_max": 1.0, "law.alpha_max": 4.0}),
    ("lab-real", {"estimator.guard": False, "plant.integration": "exact"}),
]


COLUMNS = ["x", "y", "theta", "x_est", "y_est", "theta_est", "v", "omega"]


def furthest(many: Many, robot: int, run: laglab.Run) -> float:
    """Between the two, in pose, estimate and speeds, over all ticks."""
    ticks = many.last_tick[robot] + 1
    assert ticks == len(run.trace["x"])
    there = np.hstack((many.truth, many.estimates, many.applied))[:ticks, :, robot]
    one_by_one = np.stack([run.trace[name] for name in COLUMNS], axis=1)
    assert (np.isnan(there) == np.isnan(one_by_one)).all()
    return float(np.nanmax(np.abs(there - one_by_one)))


@pytest.mark.parametrize(("name", "overrides"), QUIET)
def test_without_noise_over_the_whole_run(name, overrides):
    scenario = load(name, overrides)
    many = run_many([scenario])
    assert not many.unsure.any()
    assert furthest(many, 0, laglab.run(scenario)) < SHARP


@pytest.mark.parametrize(("name", "overrides"), NOISY)
def test_with_noise_over_the_first_seconds(name, overrides):
    scenarios = [load(name, {**overrides, "seed": seed, "duration": 3.0}) for seed in (1, 2)]
    many = run_many(scenarios)
    assert not many.unsure.any()
    for robot, scenario in enumerate(scenarios):
        assert furthest(many, robot, laglab.run(scenario)) < SHARP
