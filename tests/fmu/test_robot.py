"""The robot's motion, through both versions of FMI."""

import math
import os
import tempfile
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from fmpy.fmi3 import FMU3Slave
from hypothesis import given, settings
from hypothesis import strategies as st

from laglab_fmu import CallError, FmuNotBuiltError, Reading, Robot, RobotParameters, fmu_path
from laglab_fmu import slave as slave_module
from laglab_fmu.models import ROBOT
from laglab_fmu.slave import Slave3, initialize

QUIET = RobotParameters(noise=False, start=(-3.0, -2.0, 0.5))
SPEED = st.floats(-50, 50)


def equation_3(pose: tuple[float, float, float], left: float, right: float) -> tuple[float, ...]:
    """(1) and (3), in the order of operations that the paper writes."""
    r, L, Ts = 0.05, 0.6, 0.01
    v, omega = r * (right + left) / 2, r * (right - left) / L
    x, y, theta = pose
    return (
        x + Ts * v * math.cos(theta),
        y + Ts * v * math.sin(theta),
        theta + Ts * omega,
    )


@pytest.mark.parametrize("version", [2, 3])
def test_step_is_equation_3_bit_for_bit(version: int) -> None:
    with Robot.open(version, QUIET) as robot:
        pose: tuple[float, ...] = robot.read()[:3]
        assert pose == QUIET.start
        for tick in range(500):
            left, right = 20 * math.sin(0.1 * tick), 20 * math.cos(0.07 * tick)
            pose = equation_3((pose[0], pose[1], pose[2]), left, right)
            assert robot.step(left, right)[:3] == pose


def test_both_versions_give_the_same_bits() -> None:
    parameters = RobotParameters(seed=7, start=(-3.0, -3.0, 0.0))
    with Robot.open(2, parameters) as two, Robot.open(3, parameters) as three:
        assert two.read() == three.read()
        for tick in range(1000):
            assert two.step(1.0, math.sin(tick)) == three.step(1.0, math.sin(tick))


def test_the_heading_is_not_wrapped() -> None:
    with Robot.open(3, QUIET) as robot:
        readings = [robot.step(-10.0, 10.0) for _ in range(500)]
    assert readings[-1].theta == pytest.approx(0.5 + 5 * 0.05 * 20 / 0.6)


def test_reset_starts_again() -> None:
    parameters = RobotParameters(seed=3)
    with Robot.open(2, RobotParameters(seed=4)) as robot:
        robot.step(1.0, 2.0)
        robot.reset(parameters)
        again = [robot.read(), *(robot.step(1.0, 2.0) for _ in range(20))]
    with Robot.open(2, parameters) as robot:
        assert again == [robot.read(), *(robot.step(1.0, 2.0) for _ in range(20))]


@pytest.mark.parametrize("version", [2, 3])
def test_a_reset_may_change_the_sample_time(version: int) -> None:
    slow = RobotParameters(noise=False, sample_time=0.05)
    with Robot.open(version, replace(slow, sample_time=0.01)) as robot:
        robot.step(10.0, 10.0)
        robot.reset(slow)
        moved = [robot.step(10.0, 10.0).x for _ in range(3)]
    assert moved == pytest.approx([0.05 * 0.5 * k for k in (1, 2, 3)])


def run_with_steps(steps: list[float], parameters: RobotParameters) -> Reading:
    """Steps the FMI 3 instance by any communication steps, with constant inputs."""
    with Robot.open(3, parameters) as robot:
        slave = robot._slave
        assert isinstance(slave, Slave3)
        fmu: FMU3Slave = slave.fmu
        fmu.setFloat64([ROBOT.reference["omega_left"], ROBOT.reference["omega_right"]], [3.0, 5.0])
        time = 0.0
        for step in steps:
            fmu.doStep(time, step)
            time += step
        return robot.read()


@settings(max_examples=30)
@given(parts=st.lists(st.integers(1, 400), min_size=1, max_size=20))
def test_any_communication_step_samples_on_the_same_grid(parts: list[int]) -> None:
    """Measurement and noise are those of the sample last reached, however the way was cut."""
    parameters = RobotParameters(seed=5, measurement_variance=(0.0, 0.0, 0.01))
    steps = [part * 0.0001 for part in parts]
    total = sum(parts)
    cut = run_with_steps(steps, parameters)
    with Robot.open(3, parameters) as robot:
        whole = robot.read()
        for _ in range(total // 100):
            whole = robot.step(3.0, 5.0)
    assert cut.theta_meas == pytest.approx(whole.theta_meas, abs=1e-12)
    if total >= 100:
        assert cut.omega == whole.omega


def test_a_step_of_many_samples_is_as_many_steps() -> None:
    parameters = RobotParameters(seed=5)
    whole = run_with_steps([1.0], parameters)
    parts = run_with_steps([0.01] * 100, parameters)
    assert whole == parts


def test_steps_from_differences_of_times_are_bit_for_bit_the_sample_time() -> None:
    times = [k * 0.01 for k in range(301)]
    differences = [b - a for a, b in pairwise(times)]
    assert len(set(differences)) > 1
    assert run_with_steps(differences, RobotParameters()) == run_with_steps(
        [0.01] * 300, RobotParameters()
    )


def test_a_refused_input_leaves_the_robot_usable() -> None:
    with Robot.open(3, QUIET) as robot:
        before = robot.step(1.0, 1.0)
        with pytest.raises(CallError, match=r"tick 1: .*omega_right = nan"):
            robot.step(1.0, math.nan)
        assert robot.read() == before
        robot.step(1.0, 1.0)


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(
    ("parameters", "name"),
    [
        (RobotParameters(track=0.0), "track"),
        (RobotParameters(wheel_noise_variance=-1.0), "wheel_noise_variance"),
        (RobotParameters(start=(0.0, math.inf, 0.0)), "y_start"),
    ],
)
def test_bad_parameters_are_named(version: int, parameters: RobotParameters, name: str) -> None:
    with pytest.raises(CallError, match=f"{name} = .* refused"), Robot.open(version, parameters):
        pass


@pytest.mark.parametrize("seed", [-1, 2**31, 2**32 + 5])
def test_a_seed_out_of_range(seed: int) -> None:
    with pytest.raises(ValueError, match=f"seed is {seed}"):
        Robot.open(2, RobotParameters(seed=seed))


def test_a_closed_robot_says_so() -> None:
    robot = Robot.open(3, QUIET)
    robot.close()
    robot.close()
    with pytest.raises(CallError, match="closed"):
        robot.step(0.0, 0.0)


def test_unknown_version_and_integration() -> None:
    with pytest.raises(ValueError, match="FMI version is 1"):
        Robot.open(1, QUIET)
    with pytest.raises(ValueError, match="integration is 'rk4'"):
        Robot.open(3, RobotParameters(integration="rk4"))


def test_a_missing_fmu_says_what_to_do(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.undo()
    monkeypatch.setattr(slave_module, "__file__", str(tmp_path / "slave.py"))
    with pytest.raises(FmuNotBuiltError, match="laglab fmu build"):
        fmu_path(3)


@pytest.mark.parametrize("version", [2, 3])
def test_nothing_is_left_behind(
    version: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with Robot.open(version, QUIET) as robot:
        if os.name == "posix":  # so that nothing stays when the process is killed
            assert not list(tmp_path.iterdir())
        robot.step(1.0, 1.0)
    assert not list(tmp_path.iterdir())
    with pytest.raises(CallError):
        Robot.open(version, RobotParameters(track=0.0))
    assert not list(tmp_path.iterdir())
    (tmp_path / "bad.fmu").write_bytes(fmu_path(version).read_bytes()[:1000])
    monkeypatch.setattr(slave_module, "built", lambda _: tmp_path / "bad.fmu")
    with pytest.raises(CallError, match="laglab fmu build"):
        Robot.open(version, QUIET)
    assert [path.name for path in tmp_path.iterdir()] == ["bad.fmu"]


def test_initialize_reports_what_the_fmu_logged() -> None:
    with Robot.open(3, QUIET) as robot, pytest.raises(CallError, match="cannot be set now"):
        initialize(robot._slave, [QUIET])
