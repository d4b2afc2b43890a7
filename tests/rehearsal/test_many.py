"""Many runs at once are the runs one by one."""

import pytest

import laglab
from laglab.scenario import load

from .many_kept import furthest, kept

SHARP = 1e-9
QUIET = [
    ("fig4", {}),
    ("fig5", {}),
    ("fig6", {}),
    ("fig7", {}),
    ("fig6", {"estimator.kind": "delayed-ekf", "duration": 4.0}),
    ("fig6", {"link.command_delay": 0, "link.measurement_delay": 0, "duration": 3.0}),
    ("lab", {"noise": False, "duration": 4.0}),
    ("lab-omni", {"noise": False, "estimator.guard": False, "duration": 4.0}),
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
    ("lab", {"estimator.guard": False, "plant.kind": "car", "plant.integration": "exact"}),
    ("lab-omni", {"estimator.guard": False, "plant.measurement_variance": [0.02, 0.01, 0.001]}),
]


@pytest.mark.parametrize(("name", "overrides"), QUIET)
def test_without_noise_over_the_whole_run(name, overrides):
    scenario = load(name, overrides)
    assert furthest(kept([scenario]), 0, laglab.run(scenario)) < SHARP


@pytest.mark.parametrize(("name", "overrides"), NOISY)
def test_with_noise_over_the_first_seconds(name, overrides):
    scenarios = [load(name, {**overrides, "seed": seed, "duration": 3.0}) for seed in (1, 2)]
    many = kept(scenarios)
    for robot, scenario in enumerate(scenarios):
        assert furthest(many, robot, laglab.run(scenario)) < SHARP
