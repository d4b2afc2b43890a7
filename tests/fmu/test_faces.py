"""Model exchange and co-simulation, both versions: the same robot."""

import csv
import subprocess
import sys
from collections.abc import Callable
from ctypes import c_double
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.util import read_csv

from laglab_fmu import Reading, Robot, RobotParameters

NAMES = ["Robot2", "Robot3"]
DURATION = 2.0
STARTS = {"x_start": -3.0, "y_start": -2.0, "theta_start": 0.4, "seed": 6}


def inputs() -> np.ndarray:
    """Constant wheel speeds, so that the way an importer interpolates them does not matter."""
    kind = [("time", float), ("omega_left", float), ("omega_right", float)]
    return np.array([(0.0, 4.0, 9.0), (DURATION, 4.0, 9.0)], dtype=kind)


def simulate(fmu: Path, face: str, **options: Any) -> Any:
    settings = {"stop_time": DURATION, "output_interval": 0.01, "input": inputs()}
    return simulate_fmu(str(fmu), fmi_type=face, start_values=STARTS, **settings | options)


def stepped(**options: Any) -> np.ndarray:
    """The same run by our own stepper, (ticks + 1, 8)."""
    parameters = RobotParameters(start=(-3.0, -2.0, 0.4), seed=6, **options)
    with Robot.open(3, parameters) as robot:
        robot.read()
        return np.array([robot.step(4.0, 9.0) for _ in range(round(DURATION / 0.01))])


def columns(result: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    return np.column_stack([result[name] for name in names])


@pytest.mark.parametrize("name", NAMES)
def test_simulate_fmu_in_co_simulation_is_our_stepper(fmus: dict[str, Path], name: str) -> None:
    result = simulate(fmus[name], "CoSimulation")
    assert (columns(result, Reading._fields)[1:] == stepped()).all()


@pytest.mark.parametrize("name", NAMES)
def test_model_exchange_by_euler_agrees(fmus: dict[str, Path], name: str) -> None:
    result = simulate(fmus[name], "ModelExchange", solver="Euler", step_size=0.01)
    # at an event FMPy records before and after it: the last row of each time is the one after
    last = np.append(np.diff(result["time"]) > 1e-9, True)
    after = columns(result[last], Reading._fields)
    assert len(after) == len(stepped()) + 1
    np.testing.assert_allclose(after[1:-1], stepped()[:-1], rtol=0, atol=1e-11)


def test_a_fleet_in_model_exchange_is_the_robot(fmus: dict[str, Path]) -> None:
    """By FMPy, which leaves a fleet its default size."""
    settings: dict[str, Any] = {"stop_time": 0.3, "output_interval": 0.01}
    for solver in ("CVode", "Euler"):
        settings |= {"solver": solver, "step_size": 0.01 if solver == "Euler" else None}
        robot, fleet = (
            simulate_fmu(str(fmus[name]), fmi_type="ModelExchange", **settings)
            for name in ("Robot3", "Fleet3")
        )
        for output in Reading._fields:
            assert (fleet[output].ravel() == robot[output]).all()


@pytest.mark.parametrize("name", NAMES)
def test_model_exchange_by_cvode_agrees_with_exact_co_simulation(
    fmus: dict[str, Path], name: str
) -> None:
    result = simulate(fmus[name], "ModelExchange", solver="CVode", relative_tolerance=1e-11)
    pose = ("x", "y", "theta")
    exact = stepped(integration="exact")
    np.testing.assert_allclose(columns(result, pose)[-1], exact[-1, :3], rtol=0, atol=1e-6)
    assert np.abs(stepped()[-1, :3] - exact[-1, :3]).max() > 1e-4


def test_exact_integration_follows_the_arc() -> None:
    parameters = RobotParameters(noise=False, integration="exact", sample_time=1.0)
    with Robot.open(3, parameters) as robot:
        reading = robot.step(2.0, 8.0)
        straight = robot.step(4.0, 4.0)
    v, omega = 0.05 * 10 / 2, 0.05 * 6 / 0.6
    assert reading.x == pytest.approx(v / omega * np.sin(omega), rel=1e-14)
    assert reading.y == pytest.approx(v / omega * (1 - np.cos(omega)), rel=1e-14)
    assert straight.x - reading.x == pytest.approx(0.2 * np.cos(omega), rel=1e-13)


@pytest.mark.parametrize("name", NAMES)
def test_noise_changes_at_sample_events_only(make_face: Callable[..., Any], name: str) -> None:
    face = make_face(name, "ModelExchange")
    face.start(time=5.0)
    fmu = face.fmu

    def event(time: float) -> tuple[object, ...]:
        fmu.setTime(time)
        info: tuple[object, ...]
        info = fmu.newDiscreteStates() if face.version == 2 else fmu.updateDiscreteStates()
        return info

    *_, defined, next_time = event(5.0)
    assert defined
    assert next_time == pytest.approx(5.01)
    fmu.enterContinuousTimeMode()
    at_start = face.get("v", "omega", "x_meas")
    fmu.setTime(5.004)
    fmu.setContinuousStates((c_double * 3)(0.1, 0.2, 0.3), 3)
    assert face.get("v", "omega", "x_meas") == at_start
    assert face.get("x", "y", "theta") == [0.1, 0.2, 0.3]
    fmu.enterEventMode()
    *_, next_time = event(5.004)
    assert next_time == pytest.approx(5.01)
    assert face.get("v", "omega", "x_meas") == at_start
    *_, next_time = event(5.01)
    assert next_time == pytest.approx(5.02)
    assert face.get("v", "omega", "x_meas") != at_start


@pytest.mark.parametrize("name", [*NAMES, "Fleet3"])
def test_the_command_line_gives_the_same_path(
    fmus: dict[str, Path], tmp_path: Path, name: str
) -> None:
    """`fmpy simulate` on the default experiment, with the FMU's own reference input."""
    content = Path(__file__).parents[2] / "fmu" / "content"
    output = tmp_path / "out.csv"
    command = [sys.executable, "-m", "fmpy", "simulate", str(fmus[name])]
    command += ["--interface-type", "CoSimulation", "--output-interval", "0.01"]
    command += ["--input-file", str(content / "Robot_in.csv"), "--output-file", str(output)]
    subprocess.run(command, check=True, capture_output=True, cwd=tmp_path)
    result, reference = read_csv(output), read_csv(content / "Robot_out.csv")
    np.testing.assert_allclose(
        columns(result, Reading._fields), columns(reference, Reading._fields), rtol=0, atol=1e-9
    )
    with (content / "Robot_in.csv").open(encoding="utf-8") as file:
        given = np.array([[float(cell) for cell in row] for row in list(csv.reader(file))[1:]])
    with Robot.open(int(name[-1]), RobotParameters()) as robot:
        for tick in range(len(result) - 1):
            speeds = [np.interp(result["time"][tick], given[:, 0], given[:, i]) for i in (1, 2)]
            reading = robot.step(*speeds)
    np.testing.assert_allclose(reading[:6], columns(result, Reading._fields)[-1, :6], atol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_many_instances_do_not_disturb_each_other(make_face: Callable[..., Any], name: str) -> None:
    faces = [make_face(name, "CoSimulation") for _ in range(8)]
    for seed, face in enumerate(faces):
        face.start(seed=seed % 4)
    for tick in range(20):
        for face in faces:
            face.step(tick * 0.01)
    ends = [tuple(face.get("x_meas", "theta_meas", "v")) for face in faces]
    assert ends[:4] == ends[4:]
    assert len(set(ends)) == 4
