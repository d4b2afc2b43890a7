"""Partial derivatives: (31) and (32), directional and adjoint, and against differences."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from laglab_fmu.models import Kind

Ts, r, L = 0.01, 0.05, 0.6
STATES, WHEELS = ("x", "y", "theta"), ("omega_left", "omega_right")
DERIVATIVES = ("der(x)", "der(y)", "der(theta)")
FACES = [(n, k) for n in ("Robot2", "Robot3") for k in ("CoSimulation", "ModelExchange")]


def jacobian(face: Any, unknowns: tuple[str, ...], knowns: tuple[str, ...]) -> np.ndarray:
    """Column by column, with unit directions."""
    rows, columns = face.references(*unknowns), face.references(*knowns)
    derivative = face.fmu.getDirectionalDerivative
    return np.array([derivative(rows, columns, list(unit)) for unit in np.eye(len(knowns))]).T


@pytest.mark.parametrize(("name", "kind"), FACES)
def test_they_give_the_jacobians_of_the_paper(
    make_face: Callable[..., Any], name: str, kind: str
) -> None:
    theta, left, right = 0.7, 3.0, 5.0
    face = make_face(name, kind)
    face.start(theta_start=theta, noise=False)
    face.set(omega_left=left, omega_right=right)
    v = r * (left + right) / 2
    A = np.array([[1, 0, -Ts * v * math.sin(theta)], [0, 1, Ts * v * math.cos(theta)], [0, 0, 1]])
    W = (Ts * r / 2) * np.array(
        [
            [math.cos(theta), math.cos(theta)],
            [math.sin(theta), math.sin(theta)],
            [-2 / L, 2 / L],
        ]
    )
    np.testing.assert_allclose(
        np.eye(3) + Ts * jacobian(face, DERIVATIVES, STATES), A, rtol=1e-15, atol=0
    )
    np.testing.assert_allclose(Ts * jacobian(face, DERIVATIVES, WHEELS), W, rtol=1e-14, atol=0)


@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    theta=st.floats(-7, 7),
    left=st.floats(-20, 20),
    right=st.floats(-20, 20),
    limit=st.sampled_from([0.0, 10.0]),
    lag=st.sampled_from([0.0, 0.05]),
    slip=st.floats(0, 0.9),
)
def test_they_agree_with_differences(
    make_face: Callable[..., Any],
    theta: float,
    left: float,
    right: float,
    limit: float,
    lag: float,
    slip: float,
) -> None:
    if limit and min(abs(abs(left) - limit), abs(abs(right) - limit)) < 1e-3:
        return  # not differentiable where the limit begins
    outputs = (*DERIVATIVES, "v", "omega")

    def at(theta: float, left: float, right: float) -> tuple[Any, np.ndarray]:
        face = make_face("Robot3", "ModelExchange")
        face.start(
            theta_start=theta,
            wheel_speed_max=limit,
            motor_time_constant=lag,
            wheel_slip=slip,
            wheel_radius_error=0.1,
        )
        face.set(omega_left=left, omega_right=right)
        return face, np.array(face.get(*outputs))

    face, _ = at(theta, left, right)
    J = jacobian(face, outputs, ("theta", *WHEELS))
    point, step = np.array([theta, left, right]), 1e-5
    for column, unit in enumerate(np.eye(3)):
        difference = at(*(point + step * unit))[1] - at(*(point - step * unit))[1]
        np.testing.assert_allclose(J[:, column], difference / (2 * step), atol=1e-7)


WORN = {
    "motor_time_constant": 0.1,
    "wheel_speed_max": 4.0,
    "wheel_radius_error": 0.1,
    "track_error": 0.2,
    "wheel_slip": 0.3,
    "wheel_noise_gain": 2.0,
    "measurement_noise_gain": 0.5,
    "omega_left": 3.0,
    "omega_right": 5.0,
}
DRIVING = {"v_command": 0.5, "omega_command": 0.3}
AT_START: list[tuple[str, dict[str, float], list[str]]] = [
    *((name, WORN, ["omega_right"]) for name in ("Robot2", "Robot3", "Fleet3")),
    ("Car3", {"speed_time_constant": 0.2}, ["speed_max", "steering_max"]),
    ("Car3", {"speed_time_constant": 0.2, "speed_max": 0.4, "steering_max": 0.1}, [*DRIVING]),
    ("Omni3", {"motor_time_constant": 0.1, "first_wheel_error": 0.2}, ["wheel_speed_max"]),
    ("Omni3", {"motor_time_constant": 0.1, "wheel_speed_max": 5.0}, ["v_command"]),
]


@pytest.mark.parametrize(("name", "told", "idle"), AT_START)
def test_at_the_start_they_agree_with_differences_by_every_known(
    make_face: Callable[..., Any],
    extracted: dict[str, Path],
    name: str,
    told: dict[str, float],
    idle: list[str],
) -> None:
    """And an unknown depends on the knowns that the description tells, on no others. What is idle
    is beyond its limit, or commands what is."""
    model = read_model_description(str(extracted[name]))
    face = make_face(name, "CoSimulation")
    face.set(theta_start=0.7, seed=6, **(told if told is WORN else DRIVING | told))
    if name == "Robot2":
        face.fmu.setupExperiment()
    face.fmu.enterInitializationMode()
    knowns = [v.name for v in model.modelVariables if v.causality in ("input", "parameter")]
    table = {variable.name: variable for variable in face.model.variables}
    reals = [known for known in knowns if table[known].kind is Kind.FLOAT64]
    unknowns = tuple(unknown.variable.name for unknown in model.initialUnknowns)
    J = jacobian(face, unknowns, tuple(reals))
    for known, column in zip(reals, J.T, strict=True):
        [value] = face.get(known)
        back = face.fmu.getDirectionalDerivative(
            face.references(*unknowns), face.references(known), [-1.0]
        )
        np.testing.assert_array_equal(back, -column, err_msg=known)
        if value == table[known].minimum:
            continue
        step = 1e-6 * max(abs(value), 0.01)
        face.set(**{known: value + step})
        above = np.array(face.get(*unknowns))
        face.set(**{known: value - step})
        difference = (above - np.array(face.get(*unknowns))) / (2 * step)
        face.set(**{known: value})
        np.testing.assert_allclose(column, difference, rtol=1e-6, atol=1e-8, err_msg=known)
    for row, unknown in enumerate(model.initialUnknowns):
        depends = {known.name for known in unknown.dependencies}
        assert {known for known, entry in zip(reals, J[row], strict=True) if entry} <= depends
        assert depends <= set(knowns)
    assert [known for known, column in zip(reals, J.T, strict=True) if not column.any()] == idle


def test_a_variance_that_leaves_zero_has_no_derivative(make_face: Callable[..., Any]) -> None:
    face = make_face("Robot3", "CoSimulation")
    face.set(measurement_variance_x=0.0)
    face.fmu.enterInitializationMode()
    assert jacobian(face, ("x_meas",), ("x_start",)) == [[1.0]]
    with pytest.raises(FMICallException):
        jacobian(face, ("x_meas",), ("measurement_variance_x",))
    assert "the derivative of x_meas is" in face.messages[-1][2]
    with pytest.raises(FMICallException):
        jacobian(face, ("x",), ("x",))
    assert "(x) is not an input or a real parameter" in face.messages[-1][2]


def test_the_adjoint_is_the_transpose(make_face: Callable[..., Any]) -> None:
    face = make_face("Robot3", "CoSimulation")
    face.start(theta_start=0.3)
    face.set(omega_left=1.0, omega_right=4.0)
    unknowns, knowns = (*DERIVATIVES, "v", "omega", "x", "x_meas"), (*STATES, *WHEELS)
    J = jacobian(face, unknowns, knowns)
    rows = [
        face.fmu.getAdjointDerivative(
            face.references(*unknowns), face.references(*knowns), list(unit), len(knowns)
        )
        for unit in np.eye(len(unknowns))
    ]
    assert (np.array(rows) == J).all()
    assert not J[-1].any()


def test_what_is_no_unknown_or_known_is_named(make_face: Callable[..., Any]) -> None:
    face = make_face("Robot3", "CoSimulation")
    face.start()
    with pytest.raises(FMICallException):
        jacobian(face, ("x",), ("track",))
    with pytest.raises(FMICallException):
        jacobian(face, ("omega_left",), ("x",))
    assert "track) is not an input or a state" in face.messages[0][2]
    assert "omega_left) is not an output" in face.messages[1][2]
