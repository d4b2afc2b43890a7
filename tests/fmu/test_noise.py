"""The generator inside the FMU: its words, its normal numbers, its statistics."""

import ctypes
import subprocess
from collections.abc import Callable
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_fmu import Reading, Robot, RobotParameters, c_compiler
from laglab_fmu.archive.contents import own_files
from laglab_fmu.compiler import FLAGS, host_platform

WORD = st.integers(0, 2**64 - 1)
SAMPLES = 20_000


@pytest.fixture(scope="session", params=["-DLAGLAB", "-U__SIZEOF_INT128__"])
def noise(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """noise.c alone, as a library; also as by a compiler that has no 128 bits."""
    library = tmp_path_factory.mktemp("noise") / f"noise{host_platform().suffix}"
    source = own_files("src") / "noise.c"
    command = [*c_compiler(), *FLAGS, "-fvisibility=default", "-shared", "-fPIC", request.param]
    subprocess.run([*command, "-o", str(library), str(source), "-lm"], check=True)
    loaded = ctypes.CDLL(str(library))
    for name in ("noise_log", "noise_quantile"):
        function = getattr(loaded, name)
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double]
    return loaded


@given(seed=WORD, sample=WORD, stream=WORD)
def test_words_are_philox(noise: ctypes.CDLL, seed: int, sample: int, stream: int) -> None:
    words = (ctypes.c_uint64 * 4)()
    noise.noise_words(
        ctypes.c_uint64(seed), ctypes.c_uint64(sample), ctypes.c_uint64(stream), words
    )
    # numpy advances its counter before it draws
    counter = (sample + (stream << 64) - 1) % 2**256
    independent = np.random.Philox(key=seed, counter=counter)
    assert list(words) == [int(word) for word in independent.random_raw(4)]


@given(p=st.floats(2**-53, 1 - 2**-53))
def test_quantile_is_the_inverse_of_the_normal_distribution(noise: ctypes.CDLL, p: float) -> None:
    assert noise.noise_quantile(p) == pytest.approx(NormalDist().inv_cdf(p), rel=1e-14, abs=1e-16)


@given(x=st.floats(2**-1022, 1e308))
def test_logarithm(noise: ctypes.CDLL, x: float) -> None:
    exact = np.log(x)
    assert abs(noise.noise_log(x) - exact) <= 3 * np.spacing(max(abs(exact), 2**-52))


def record(parameters: RobotParameters, samples: int = SAMPLES) -> np.ndarray:
    """Readings at ticks 0 ... samples, as an array (samples + 1, 8)."""
    with Robot.open(3, parameters) as robot:
        return np.array([robot.read(), *(robot.step(1.0, 1.0) for _ in range(samples))])


def residuals(readings: np.ndarray, parameters: RobotParameters) -> np.ndarray:
    """The five noises, (samples, 5): w_L, w_R out of v and omega, then the measurement's."""
    x = {name: readings[:, i] for i, name in enumerate(Reading._fields)}
    mean, difference = (
        x["v"] / parameters.wheel_radius,
        x["omega"] * parameters.track / parameters.wheel_radius,
    )
    return np.column_stack(
        [
            mean - difference / 2 - 1.0,
            mean + difference / 2 - 1.0,
            x["x_meas"] - x["x"],
            x["y_meas"] - x["y"],
            x["theta_meas"] - x["theta"],
        ]
    )[1:]


def test_variances_whiteness_and_independence() -> None:
    parameters = RobotParameters(
        wheel_noise_variance=0.04, measurement_variance=(0.01, 0.02, 0.018), seed=11
    )
    noises = residuals(record(parameters), parameters)
    standard = noises / np.sqrt([0.04, 0.04, 0.01, 0.02, 0.018])
    bound = 5 / np.sqrt(SAMPLES)
    assert np.abs(standard.mean(axis=0)).max() < bound
    # the variance of a sample variance of normal numbers is 2/N; of their fourth moment 96/N
    assert np.abs((standard**2).mean(axis=0) - 1).max() < bound * np.sqrt(2)
    assert np.abs((standard**4).mean(axis=0) - 3).max() < bound * np.sqrt(96)
    for lag in (1, 2, 3, 10):
        correlations = standard[:-lag].T @ standard[lag:] / (SAMPLES - lag)
        assert np.abs(correlations).max() < bound
    across = standard.T @ standard / SAMPLES - np.diag((standard**2).mean(axis=0))
    assert np.abs(across).max() < bound


def test_seeds_are_independent() -> None:
    one, other = (
        residuals(record(RobotParameters(seed=seed)), RobotParameters()) for seed in (1, 2)
    )
    correlations = [np.corrcoef(one[:, i], other[:, i])[0, 1] for i in range(5)]
    assert np.abs(correlations).max() < 5 / np.sqrt(SAMPLES)


def test_without_noise_every_variance_acts_as_zero() -> None:
    readings = record(RobotParameters(noise=False), samples=50)
    assert (readings[:, 0:3] == readings[:, 3:6]).all()
    assert readings[-1, 6] == 0.05


@pytest.mark.parametrize("name", ["Robot2", "Robot3"])
def test_the_gains_are_tuned_on_the_way(make_face: Callable[..., Any], name: str) -> None:
    """From the next sample on; the draws stay those of the seed and the sample."""
    outputs = ("v", "omega", "x", "x_meas")
    tuned, plain = (make_face(name, "CoSimulation") for _ in range(2))
    for face in (tuned, plain):
        face.start(seed=4)
        face.set(wheel_noise_gain=1.0)
        face.step(0.0)
    tuned.set(wheel_noise_gain=3.0, measurement_noise_gain=0.0)
    assert tuned.get(*outputs) == plain.get(*outputs)
    for face in (tuned, plain):
        face.step(0.01)
    v, omega, x, x_meas = tuned.get(*outputs)
    assert x_meas == x == plain.get("x")[0] != plain.get("x_meas")[0]
    assert [v, omega] == pytest.approx([3 * value for value in plain.get("v", "omega")], rel=1e-12)


def test_one_noise_does_not_disturb_the_other() -> None:
    both = record(RobotParameters(), samples=50)
    still = record(RobotParameters(wheel_noise_variance=0.0), samples=50)
    assert np.allclose((both[:, 3:6] - both[:, 0:3]), (still[:, 3:6] - still[:, 0:3]), atol=1e-15)
